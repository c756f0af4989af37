"""The process: its socket, TLS, threads and end."""

from __future__ import annotations

import asyncio
import gc
import ipaddress
import resource
import socket
import ssl
import sys
from pathlib import Path
from typing import Final

import uvicorn

from rigid.errors import UserError
from rigid.interrupts import terminated_as_interrupted
from rigid.study.service.app import build_app
from rigid.study.service.context import Service
from rigid.study.service.messages import LIVE_BYTES
from rigid.study.service.protocols import CountingHTTP, CountingWebSocket

HEAD_BYTES: Final = 16 * 1024
"""Longest head of a request."""
GRACE_SECONDS: Final = 15
"""How long answers and episodes that are being stored may take at the end [s]. Ours."""
_SWITCH: Final = 0.001
"""How long a thread may hold Python before another gets its turn [s]: 5 ms, the default, is felt
when many episodes are stepped beside the one that sends their frames."""
_FILES: Final = 65_536


def listen(host: str, port: int) -> socket.socket:
    """A bound socket, so that a bad place is known before anything slow begins.

    Raises:
        UserError: The host is unknown, or the port taken or not allowed.
    """
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except OSError as error:
        raise UserError(f"--host {host!r} is unknown ({error.strerror}): try 127.0.0.1") from None
    family, kind, protocol, _, place = found[0]
    opened = socket.socket(family, kind, protocol)
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        opened.bind(place)
        opened.listen(512)
    except OSError as error:
        opened.close()
        raise UserError(
            f"cannot listen on {host} port {port} ({error.strerror}): choose another with --port"
        ) from None
    return opened


def address_of_server(opened: socket.socket, host: str, *, tls: bool) -> str:
    """How a browser reaches a socket; the machine's name where it listens everywhere.

    Example:
        >>> with listen("127.0.0.1", 0) as opened:
        ...     address_of_server(opened, "127.0.0.1", tls=True).startswith("https://127.0.0.1:")
        True
    """
    name = host
    try:
        found = ipaddress.ip_address(host)
        name = f"[{host}]" if found.version == 6 else host
        name = socket.gethostname() if found.is_unspecified else name
    except ValueError:
        pass
    port = opened.getsockname()[1]
    usual = 443 if tls else 80
    return f"http{'s' if tls else ''}://{name}" + ("" if port == usual else f":{port}")


def check_tls(certificate: Path | None, key: Path | None) -> None:
    """Opens a certificate, so that a bad one is known at once.

    Raises:
        UserError: It cannot be read, or there is a key without one.
    """
    if certificate is None:
        if key is not None:
            raise UserError("--tls-key needs its certificate: add --tls-cert FILE.pem")
        return
    for path in (certificate, key):
        if path is not None and not path.is_file():
            raise UserError(f"{path} is no file: --tls-cert and --tls-key name PEM files")
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key, password="")
    except (OSError, ValueError) as error:
        raise UserError(
            f"{certificate} is no certificate with its private key ({error}): give PEM files, the "
            "key without password, with --tls-cert and --tls-key"
        ) from None


def serve(
    service: Service,
    opened: socket.socket,
    *,
    certificate: Path | None = None,
    key: Path | None = None,
) -> None:
    """Serves until the process is told to end; nothing that was acknowledged is lost, ever.

    Raises:
        KeyboardInterrupt: It was, by a signal; all is closed.
    """
    server = server_of(service, certificate=certificate, key=key)
    _allow_many_files()
    sys.setswitchinterval(_SWITCH)
    gc.collect()
    gc.freeze()  # What is there now stays: looking through it takes tens of milliseconds.
    try:
        with terminated_as_interrupted():  # uvicorn raises the signal again at the end.
            asyncio.run(server.serve(sockets=[opened]))
    finally:
        service.close()


def server_of(
    service: Service, *, certificate: Path | None = None, key: Path | None = None
) -> uvicorn.Server:
    """The server of a service, its limits set; `serve(sockets=[…])` runs it."""
    config = uvicorn.Config(
        build_app(service),
        http=CountingHTTP,
        ws=CountingWebSocket,
        loop="asyncio",
        lifespan="on",
        interface="asgi3",
        ws_max_size=LIVE_BYTES,
        ws_per_message_deflate=False,  # Frames are dense already; and no bombs.
        h11_max_incomplete_event_size=HEAD_BYTES,
        ssl_certfile=certificate,
        ssl_keyfile=key,
        proxy_headers=False,  # Anybody can write them.
        server_header=False,
        access_log=False,  # Paths hold tokens.
        log_config=None,
        log_level="critical",  # Or whoever sends rubbish fills the terminal; faults are told by us.
        timeout_graceful_shutdown=GRACE_SECONDS,
    )
    return uvicorn.Server(config)


def _allow_many_files() -> None:
    """Each connection is an open file; the usual limit is 1024."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = _FILES if hard == resource.RLIM_INFINITY else min(hard, _FILES)
    if soft < most:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))

"""Bytes on a socket, for what no well-behaved library would send."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import re
import secrets

_STATUS = re.compile(rb"HTTP/1\.1 (\d{3})")
_ANSWER_SECONDS = 15.0


async def answer_to(port: int, *parts: bytes) -> int | None:
    """The HTTP status that raw bytes are answered with; None where the connection is only closed.

    Args:
        port: Of the server on this machine.
        parts: Sent one after another; the second and later ones after a status came.
    """
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    status = None
    try:
        for part in parts:
            writer.write(part)
            await writer.drain()
            found = await _status(reader)
            status = found if found is not None else status
    except ConnectionError:
        pass
    finally:
        writer.close()
        with contextlib.suppress(ConnectionError):
            await writer.wait_closed()
    return status


async def close_code_of(port: int, path: str, frames: bytes) -> int | None:
    """The code with which a WebSocket is closed after raw frames; None where it stays open."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        writer.write(handshake(path))
        await writer.drain()
        if await _status(reader) != 101:
            return 0
        writer.write(frames)
        await writer.drain()
        async with asyncio.timeout(_ANSWER_SECONDS):
            return await _close_code(reader)
    except (ConnectionError, asyncio.IncompleteReadError):
        return 0
    except TimeoutError:
        return None
    finally:
        writer.close()
        with contextlib.suppress(ConnectionError):
            await writer.wait_closed()


def request(line: str, *headers: str, body: bytes = b"") -> bytes:
    """A request of HTTP/1.1, whatever its parts say."""
    head = "\r\n".join([line, "Host: 127.0.0.1", *headers])
    return head.encode("latin-1") + b"\r\n\r\n" + body


def handshake(path: str, *, key: bool = True, version: int = 13) -> bytes:
    """The request that becomes a WebSocket."""
    headers = ["Connection: Upgrade", "Upgrade: websocket", f"Sec-WebSocket-Version: {version}"]
    if key:
        headers.append(f"Sec-WebSocket-Key: {base64.b64encode(secrets.token_bytes(16)).decode()}")
    return request(f"GET {path} HTTP/1.1", *headers)


async def _status(reader: asyncio.StreamReader) -> int | None:
    try:
        async with asyncio.timeout(_ANSWER_SECONDS):
            head = await reader.readuntil(b"\r\n\r\n")
    except asyncio.IncompleteReadError as error:
        head = error.partial
    except (TimeoutError, ConnectionError):
        return None
    found = _STATUS.match(head)
    return int(found[1]) if found else None


async def _close_code(reader: asyncio.StreamReader) -> int:
    """Reads frames until one closes."""
    while True:
        first, length = await reader.readexactly(2)
        size = length & 0x7F
        if size == 126:
            size = int.from_bytes(await reader.readexactly(2), "big")
        elif size == 127:
            size = int.from_bytes(await reader.readexactly(8), "big")
        data = await reader.readexactly(size)
        if first & 0x0F == 8:
            return int.from_bytes(data[:2], "big")

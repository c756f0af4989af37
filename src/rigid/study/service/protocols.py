"""The wire below the application: what is no HTTP or WebSocket at all is counted too."""

from __future__ import annotations

import asyncio
from asyncio.transports import BaseTransport, Transport
from collections import Counter
from socket import SO_SNDBUF, SOL_SOCKET
from typing import Any, Final

import h11
from uvicorn.config import Config
from uvicorn.protocols.http.h11_impl import H11Protocol, RequestResponseCycle
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from uvicorn.server import ServerState
from websockets.http11 import Request

from rigid.study.service.limits import CONNECTED, Bucket, Rate, network
from rigid.study.service.refusing import Refusals

HEADER_SECONDS: Final = 10.0
"""How long the head of a request may take to arrive [s], so that drops hold no line. Ours."""
_PINGS: Final = Rate(20, 2)
"""Ping frames, which the application does not see. Ours: browsers send none."""
UNREAD_BYTES: Final = 64 * 1024
"""Frames that wait for who does not read, here and as many in the system. Ours: about half a second
of an episode."""


class CountingHTTP(H11Protocol):
    """HTTP/1.1; gives up on requests that never end."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # uvicorn narrows asyncio's type too: sockets have a Transport.
        """A connection was opened."""
        super().connection_made(transport)
        self._late: asyncio.TimerHandle | None = None
        self._of = network(self.client[0] if self.client else None)
        if _enters(self.app_state, self._of):
            self._wait_for_head()
        else:
            _refusals(self.app_state).count("wire", "too-many")
            self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """A connection was closed."""
        self._head_is_there()
        _leaves(self.app_state, self._of)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Bytes came."""
        super().data_received(data)
        waiting = self.conn.their_state is h11.IDLE
        if waiting and self._late is None and not self.transport.is_closing():
            self._wait_for_head()
        elif not waiting:
            self._head_is_there()

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """The connection becomes a WebSocket."""
        self._head_is_there()
        super().handle_websocket_upgrade(event)  # Which tells of the end of the connection.

    def send_400_response(self, msg: str) -> None:
        """What came is no HTTP."""
        _refusals(self.app_state).count("wire", "no-http")
        self._head_is_there()
        cycle = self._cycle()
        if cycle is not None and not cycle.response_complete:
            cycle.disconnected = True  # Who waits for the rest of the request waits in vain.
            cycle.message_event.set()
        if self.conn.our_state in {h11.IDLE, h11.SEND_RESPONSE}:
            super().send_400_response(msg)
        else:  # In the middle of an answer there is no place for another.
            self.transport.abort()

    def _cycle(self) -> RequestResponseCycle | None:
        """The newest request and its answer; None before the first."""
        return self.cycle

    def _wait_for_head(self) -> None:
        self._late = self.loop.call_later(HEADER_SECONDS, self._give_up)

    def _head_is_there(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _give_up(self) -> None:
        self._late = None
        if not self.transport.is_closing():
            _refusals(self.app_state).count("wire", "too-slow")
            self.transport.abort()


class CountingWebSocket(WebSocketsSansIOProtocol):
    """WebSockets; bad handshakes, bad frames and floods of pings are counted."""

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self._refusals = _refusals(app_state)
        self._pings = Bucket(_PINGS, self.loop.time())

    def connection_made(self, transport: BaseTransport) -> None:
        """The connection of an HTTP request becomes a WebSocket."""
        if isinstance(transport, Transport):
            transport.set_write_buffer_limits(high=UNREAD_BYTES)
            # Otherwise the system holds up to megabytes for who reads nothing: minutes of play.
            transport.get_extra_info("socket").setsockopt(SOL_SOCKET, SO_SNDBUF, UNREAD_BYTES)
        super().connection_made(transport)
        self._of = network(self.client[0] if self.client else None)

    def connection_lost(self, exc: Exception | None) -> None:
        """A connection was closed, which came in by `CountingHTTP`."""
        _leaves(self.app_state, self._of)
        super().connection_lost(exc)

    def handle_connect(self, event: Request) -> None:
        """A handshake came."""
        super().handle_connect(event)
        if self.response.status_code != 101:
            self._refusals.count("wire", "bad-handshake")

    def keepalive_timeout(self) -> None:
        """No answer to a ping: nobody is there who could take what is left to be sent."""
        super().keepalive_timeout()
        self.transport.abort()

    async def run_asgi(self) -> None:
        """Serves the connection; who does not read the end of it is cut off in the end."""
        await super().run_asgi()
        self.loop.call_later(self.close_timeout, self.transport.abort)

    def handle_ping(self) -> None:
        """A ping came; it was answered already, and the answer waits to be sent."""
        if self._pings.take(self.loop.time()):
            super().handle_ping()
            return
        self._refusals.count("wire", "too-many")
        self.transport.abort()

    def handle_parser_exception(self) -> None:
        """What came is no WebSocket frame, no text, or too large."""
        self._refusals.count("wire", "bad-frame")
        super().handle_parser_exception()


def _refusals(app_state: dict[str, Any]) -> Refusals:
    """Those of the service, which its lifespan gave to the server."""
    refusals: Refusals = app_state["refusals"]
    return refusals


def _enters(app_state: dict[str, Any], sender: str) -> bool:
    """Counts one more connection of a sender; False where there are too many."""
    connected: Counter[str] = app_state["connected"]
    connected[sender] += 1
    return connected[sender] <= CONNECTED


def _leaves(app_state: dict[str, Any], sender: str) -> None:
    connected: Counter[str] = app_state["connected"]
    connected[sender] -= 1
    if connected[sender] <= 0:
        del connected[sender]

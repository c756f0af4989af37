"""Live play: one WebSocket a participant, one episode at a time."""

from __future__ import annotations

import asyncio
import datetime as dt
import json
import logging
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Any, Final

from starlette.responses import PlainTextResponse
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from rigid.study.play.frame import frame_bytes
from rigid.study.records import Participant
from rigid.study.service.context import Service
from rigid.study.service.messages import Begin, Halt, LiveMessage, Ping, Target, read_live
from rigid.study.service.paced import Hand, play_paced
from rigid.study.service.refusing import Refusal
from rigid.study.service.requests import participant_of, service_of
from rigid.study.service.state import standpoint
from rigid.study.service.told import acknowledgement, announcement, record_of
from rigid.study.store import ConflictError, GoneError

BAD_TOKEN: Final = 4401
ELSEWHERE: Final = 4409
TOO_MANY: Final = 4429
FAULT: Final = 1011
SEND_SECONDS: Final = 5.0
"""A participant whose connection takes nothing for so long is gone [s]. Ours."""

_log = logging.getLogger(__name__)


async def live(socket: WebSocket) -> None:
    """Serves one connection to its end."""
    service = service_of(socket)
    try:
        participant = await participant_of(socket)
        service.allow(service.rates.connections, participant.code)
    except Refusal as refusal:
        service.refusals.count("live", refusal.code)
        if refusal.code == "too-many":
            await socket.send_denial_response(PlainTextResponse("too many", status_code=429))
            return
        await socket.accept()
        await socket.close(BAD_TOKEN, "unknown link")
        return
    await socket.accept()
    connection = LiveConnection(service, socket, participant)
    earlier = service.live.get(participant.code)
    service.live[participant.code] = connection
    try:
        if earlier is not None:
            await earlier.leave(ELSEWHERE, "opened elsewhere")
        await connection.serve()
    finally:
        if service.live.get(participant.code) is connection:
            del service.live[participant.code]
        connection.ended.set()


class LiveConnection:
    """What is said over one WebSocket, and the episode that runs behind it."""

    def __init__(self, service: Service, socket: WebSocket, participant: Participant) -> None:
        self._service, self._socket, self._participant = service, socket, participant
        self._newest = -1
        self._hand = Hand()
        self._playing: asyncio.Task[None] | None = None
        self._whole = False
        """Whether all steps are done, so that the episode is stored, come what may."""
        self._leaving = False
        self._reading: asyncio.Task[None] | None = None
        self.ended = asyncio.Event()
        """Set once nothing of this connection goes on, nor writes, any more."""

    async def serve(self) -> None:
        """Reads messages until the connection ends, one way or the other."""
        self._reading = asyncio.create_task(self._read(), name="messages")
        try:
            await self._reading
        except (WebSocketDisconnect, TimeoutError, asyncio.CancelledError):  # Gone, or left.
            return
        finally:
            await self._abandon()

    async def leave(self, code: int, reason: str) -> None:
        """Closes the connection; returns when nothing of it goes on."""
        self._leaving = True
        await self._abandon()
        await self._close(code, reason)
        if self._reading is not None:  # Who went without a word would keep it waiting.
            self._reading.cancel()
        await self.ended.wait()

    async def _read(self) -> None:
        while not self._leaving:
            message = await self._socket.receive()
            if message["type"] == "websocket.disconnect" or not await self._heard(message):
                return

    async def _heard(self, message: Any) -> bool:
        """One message; False where the connection is to end."""
        if self._leaving:
            return False
        service, code = self._service, self._participant.code
        if not service.rates.messages.take(code, service.clock()):
            service.refusals.count("live", "too-many")
            await self._close(TOO_MANY, "too many messages")
            return False
        try:
            await self._obey(self._understood(message))
        except Refusal as refusal:
            service.refusals.count("live", refusal.code)
            if not service.rates.refused.take(code, service.clock()):
                await self._close(TOO_MANY, "too many refused messages")
                return False
            await self._say({"type": "refused", "reason": refusal.code})
        return True

    def _understood(self, message: Any) -> LiveMessage:
        text = message.get("text")
        if text is None:
            raise Refusal("malformed", "live messages are text")
        said = read_live(text)
        if said.n <= self._newest:
            raise Refusal("replayed", "n must grow from message to message")
        self._newest = said.n
        return said

    async def _obey(self, said: LiveMessage) -> None:
        service = self._service
        match said:
            case Target():
                now = service.clock()
                if not service.rates.targets.take(self._participant.code, now):
                    raise Refusal("too-many", "at most 30 targets a second")
                self._hand.put(said.position, now)
            case Ping():
                await self._say({"type": "pong", "sent": said.sent})
            case Begin():
                if self._playing is not None and not self._playing.done():
                    raise Refusal("not-now", "an episode is running")
                self._playing = asyncio.create_task(self._play(said), name="episode")
            case Halt():
                await self._abandon()
                await self._say({"type": "stopped"})

    async def _abandon(self) -> None:
        """Ends the running episode; one that is over is stored first."""
        playing = self._playing
        if playing is None:
            return
        if not self._whole:
            playing.cancel()
        await asyncio.wait({playing})

    async def _play(self, wish: Begin) -> None:
        """The next episode, from its start until it is stored."""
        try:
            await self._play_next(wish)
        except Refusal as refusal:
            await self._refuse(refusal.code)
        except (GoneError, ConflictError):  # They stopped, or withdrew, while it ran.
            await self._refuse("not-now")
        except (WebSocketDisconnect, TimeoutError):
            await self._close(FAULT, "nothing is read")
        except Exception:  # noqa: BLE001 - Robots are anybody's code; told, logged, and no other's problem.
            _log.exception("an episode of %s broke off", self._participant.code)
            self._service.refusals.count("live", "fault")
            await self._close(FAULT, "the server failed")

    async def _play_next(self, wish: Begin) -> None:
        service, code = self._service, self._participant.code
        where = (await service.desk.do(standpoint, service.plan, service.store, code)).position
        following = where.episode
        if following is None or where.index is None:
            raise Refusal("not-now", "nothing is to be played now")
        store = service.store
        attempts = await service.desk.do(
            store.begin_attempt, code, following.kind, following.number
        )
        episode = await service.engine.do(service.engine.episode, following.robot, following.seed)
        first = await service.engine.do(episode.begin)
        self._hand.forget()
        started = dt.datetime.now(dt.UTC).isoformat(timespec="milliseconds")
        await self._say(announcement(where, following, episode, first))
        await self._send(frame_bytes(first))
        last = await play_paced(
            service.engine, episode, first, self._hand, self._send,
            measured=service.periods.append, clock=service.clock, sleep=service.sleep,
        )  # fmt: skip
        self._whole = True
        try:
            with suppress(WebSocketDisconnect, TimeoutError):
                await self._send(last)
            played = await service.engine.do(episode.finish)
            record = record_of(self._participant, following, wish, played, attempts, started)
            await service.desk.do(store.add_episode, record, where.index)
        finally:
            self._whole = False
        await self._say(acknowledgement(where, following, played))

    async def _refuse(self, code: str) -> None:
        """Tells that an episode is not begun or not kept, if anybody is there."""
        self._service.refusals.count("live", code)
        with suppress(WebSocketDisconnect, TimeoutError):
            await self._say({"type": "refused", "reason": code})

    async def _say(self, message: dict[str, Any]) -> None:
        text = json.dumps(message, allow_nan=False)
        await self._within(lambda: self._socket.send_text(text))

    async def _send(self, data: bytes) -> None:
        await self._within(lambda: self._socket.send_bytes(data))

    async def _within(self, send: Callable[[], Awaitable[None]]) -> None:
        """Sends, or finds that nobody is there.

        Raises:
            WebSocketDisconnect: The connection is closed.
            TimeoutError: The other side reads nothing.
        """
        if self._socket.application_state is not WebSocketState.CONNECTED:
            raise WebSocketDisconnect(1006)
        try:
            async with asyncio.timeout(SEND_SECONDS):
                await send()
        except RuntimeError:  # uvicorn's, where its own ping found nobody: it is closing already.
            raise WebSocketDisconnect(1006) from None

    async def _close(self, code: int, reason: str) -> None:
        with suppress(WebSocketDisconnect, TimeoutError):
            await self._within(lambda: self._socket.close(code, reason))

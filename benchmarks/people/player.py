"""A scripted participant over real HTTP and WebSockets, who comes back whatever happens."""

from __future__ import annotations

import asyncio
import json
import math
import struct
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import httpx
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake

_TARGETS_A_SECOND = 20  # As the page sends them.
_AGAIN_SECONDS = 0.3
"""Until another try where nobody answers."""


@dataclass
class Seen:
    """What a player saw of the service."""

    periods: list[float] = field(default_factory=list)
    """Between two frames of an episode, as they arrived [s]."""
    finished: list[tuple[str, int]] = field(default_factory=list)
    """Kind and number of each episode that the server acknowledged."""
    watched: list[str] = field(default_factory=list)
    """Replays whose end the server acknowledged."""
    broken_off: int = 0
    """Episodes that a lost connection ended."""
    refused: Counter[str] = field(default_factory=Counter)
    """What the server refused of this player."""
    resumed_wrongly: list[str] = field(default_factory=list)
    """Acknowledged work that the server did not know of afterwards."""


class Player:
    """Consents, watches, and plays one episode after another."""

    def __init__(self, address: str, token: str, *, phase: float = 0.0) -> None:
        """Builds it.

        Args:
            address: Of the server.
            token: Of this player's link.
            phase: Where the hand begins to circle [rad].
        """
        self._page = f"{address}/p/{token}"
        self._live = f"{self._page.replace('http', 'ws', 1)}/live"
        self._phase, self.seen, self._n, self._until = phase, Seen(), 0, math.inf

    def last_episode(self) -> None:
        """Plays no other after the one that runs."""
        self._until = time.monotonic()

    async def play(self, until: float) -> None:
        """Plays on until a time of `time.monotonic`, or until everything is done."""
        self._until = until
        async with httpx.AsyncClient(timeout=30) as client:
            while time.monotonic() < self._until:
                try:
                    if not await self._next(client):
                        return
                except (httpx.TransportError, ConnectionClosed, InvalidHandshake, OSError):
                    await asyncio.sleep(_AGAIN_SECONDS)

    async def _next(self, client: httpx.AsyncClient) -> bool:
        """Does what comes next; False where nothing does."""
        stage = (await self._ask(client, "state"))["stage"]
        match stage["kind"]:
            case "consent":
                said = {"version": stage["version"], "agreed": True, "sharing": False}
                await self._ask(client, "consent", said)
            case "demographics":
                await self._ask(client, "demographics", {})
            case "watch":
                episode = stage["episodes"][stage["seen"]]
                said = {"stage": stage["index"], "episode": episode}
                await self._ask(client, "watched", said)
                self.seen.watched.append(episode)
            case "practise" | "play" as kind:
                known = sum(kind == played for played, _ in self.seen.finished)
                if stage["done"] < known:
                    self.seen.resumed_wrongly.append(f"{kind}: {stage['done']} of {known}")
                await self._live_play()
            case _:
                return False
        return True

    async def _ask(
        self, client: httpx.AsyncClient, what: str, said: dict[str, Any] | None = None
    ) -> dict[str, Any]:
        url = f"{self._page}/api/{what}"
        answer = await (client.get(url) if said is None else client.post(url, json=said))
        if answer.status_code != httpx.codes.OK:
            self.seen.refused[answer.json()["error"]] += 1
            await asyncio.sleep(_AGAIN_SECONDS)
        found: dict[str, Any] = answer.json()
        return found

    async def _live_play(self) -> None:
        """Episodes over one connection, for as long as it holds and the stage goes on."""
        async with connect(self._live, compression=None) as socket:
            self._n = 0
            while time.monotonic() < self._until:
                await self._say(socket, {"type": "start", "device": "scripted", "about": {}})
                try:
                    if await self._episode(socket):
                        return
                except ConnectionClosed:
                    self.seen.broken_off += 1
                    raise

    async def _say(self, socket: ClientConnection, message: dict[str, Any]) -> None:
        self._n += 1
        await socket.send(json.dumps({**message, "n": self._n}))

    async def _episode(self, socket: ClientConnection) -> bool:
        """One episode; True where it was the last of its stage, or none began."""
        before, kind, moving = None, "", None
        try:
            async for message in socket:
                if isinstance(message, bytes):
                    now = time.monotonic()
                    step = struct.unpack_from("<I", message)[0]
                    if before is not None and step > 1:
                        self.seen.periods.append(now - before)
                    before = now
                    continue
                said = json.loads(message)
                if said["type"] == "episode":
                    kind = said["kind"]
                    moving = asyncio.create_task(self._move(socket, said["hand"]))
                elif said["type"] == "finished":
                    self.seen.finished.append((kind, said["number"]))
                    return bool(said["done"] == said["of"])
                elif said["type"] == "refused":
                    self.seen.refused[said["reason"]] += 1
                    return True
        finally:
            if moving is not None:
                moving.cancel()
        return True

    async def _move(self, socket: ClientConnection, hand: list[float]) -> None:
        """Circles slowly about where the hand was."""
        begin = time.monotonic()
        while True:
            angle = self._phase + (time.monotonic() - begin)
            aim = [hand[0], hand[1] + 0.1 * math.cos(angle), hand[2] + 0.1 * math.sin(angle)]
            try:
                await self._say(socket, {"type": "target", "step": 0, "position": aim})
            except ConnectionClosed:
                return
            await asyncio.sleep(1 / _TARGETS_A_SECOND)

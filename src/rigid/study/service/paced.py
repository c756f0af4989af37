"""One episode in real time: steps by the server's clock, with the newest hand target."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from math import inf

import numpy as np
from jaxtyping import Float

from rigid.study.play.episode import PlayedEpisode
from rigid.study.play.frame import Frame, frame_bytes
from rigid.study.service.engine import Engine
from rigid.study.service.pacing import Schedule

Clock = Callable[[], float]
"""Seconds that never go back."""
Sleep = Callable[[float], Awaitable[None]]
"""Waits for so many of them."""


@dataclass
class Hand:
    """Where a participant last wanted the hand."""

    _position: Float[np.ndarray, "3"] | None = None
    _came: float = field(default=-inf)

    def put(self, position: tuple[float, float, float], now: float) -> None:
        """A target came."""
        self._position, self._came = np.array(position), now

    def at(
        self, now: float, *, otherwise: Float[np.ndarray, "3"]
    ) -> tuple[Float[np.ndarray, "3"], float]:
        """The newest target and its age [s]; `otherwise` and inf before the first came."""
        if self._position is None:
            return otherwise, inf
        return self._position, now - self._came

    def forget(self) -> None:
        """An episode begins: targets of the last one are not its own."""
        self._position, self._came = None, -inf


async def play_paced(
    engine: Engine,
    episode: PlayedEpisode,
    first: Frame,
    hand: Hand,
    send: Callable[[bytes], Awaitable[None]],
    *,
    measured: Callable[[float], None] = lambda _: None,
    clock: Clock = time.monotonic,
    sleep: Sleep = asyncio.sleep,
) -> bytes:
    """Plays an episode that has begun to its end; returns the last frame, which is not sent yet.

    So whoever asked for it knows that the episode is whole before anything can go wrong with
    sending.

    Args:
        engine: Steps it.
        episode: What is played.
        first: The frame with which it began; the first step is due a period later.
        hand: Asked at each step. Until it is told anything, the hand stays where it is.
        send: Takes each frame to the participant, but for the first and the last.
        measured: Told the time between the beginnings of two steps [s].
        clock: The server's.
        sleep: Waits so long on that clock.
    """
    start = clock() + episode.period
    schedule = Schedule(episode.period, start)
    rest, before, frame = first.hand, start, first
    while True:
        await sleep(max(0.0, schedule.due - clock()))
        now = clock()
        schedule.began(now)
        if frame.step:
            measured(now - before)
        before = now
        target, age = hand.at(now, otherwise=rest)
        frame, data = await engine.step(_step, episode, target, age, max(0.0, now - start))
        if frame.done:
            return data
        await send(data)


def _step(
    episode: PlayedEpisode, target: Float[np.ndarray, "3"], age: float, at: float
) -> tuple[Frame, bytes]:
    frame = episode.advance(target, age=age, at=at)
    return frame, frame_bytes(frame)

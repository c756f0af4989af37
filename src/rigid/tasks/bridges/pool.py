"""Many environments that are not batched, stepped side by side by worker processes.

Every process has its share of the worlds. A world's episode depends on its seed alone, so that the
numbers are the same for any number of processes; one of them is this process itself.
"""

from __future__ import annotations

import weakref
from itertools import count
from multiprocessing.connection import Connection
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped

from rigid.errors import UserError
from rigid.tasks.bridges.desk import Desk, Rows, serve
from rigid.tasks.bridges.playing import Opener

FEWEST = 8
"""Worlds for which another process is worth its messages. Ours: a message takes about 0.1 ms, a
step of a small environment as long."""


class Pool:
    """The environments of one task; they stay open until the task is gone."""

    def __init__(self, opener: Opener, name: str) -> None:
        self._opener, self._name = opener, name
        self._here: _Here | None = None
        self._workers: list[_Worker] = []
        self._numbers = count()

    def lease(self, batch: int, threads: int) -> Lease:
        """So many worlds.

        Args:
            batch: How many.
            threads: Processes that step them; 0: one for every core.
        """
        processes = min(threads or _cores(), max(batch // FEWEST, 1))
        if processes == 1:
            self._here = self._here or _Here(Desk(self._opener, self._name))
            hands: list[_Here | _Worker] = [self._here]
        else:
            while len(self._workers) < processes:
                self._workers.append(_Worker(self._opener, self._name))
            hands = list(self._workers[:processes])
        return Lease(next(self._numbers), batch, hands)


class Lease:
    """B worlds, for as long as somebody holds this object."""

    def __init__(self, number: int, batch: int, hands: list[_Here | _Worker]) -> None:
        self.batch = batch
        self._number, self._hands = number, hands
        self._bounds = np.linspace(0, batch, len(hands) + 1).astype(int)[1:-1]
        for hand in hands:  # Only noted: a collector may run in the middle of a message.
            weakref.finalize(self, hand.done_with.append, number)

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Rows:
        """Begins an episode in every world.

        Raises:
            UserError: An environment fails, or its process was killed.
        """
        parts = np.split(seeds, self._bounds)
        for hand, part in zip(self._hands, parts, strict=True):
            hand.ask("reset", self._number, part)
        return _joined(_answers(self._hands))

    def step(
        self,
        running: Bool[np.ndarray, " B"],
        robot: Float[np.ndarray, "B a_r"],
        human: Float[np.ndarray, "B a_h"],
    ) -> Rows:
        """Advances the worlds that are running, of which there must be one at least.

        Raises:
            UserError: An environment fails, or its process was killed.
        """
        columns = [np.split(column, self._bounds) for column in (running, robot, human)]
        asked = []
        for hand, *parts in zip(self._hands, *columns, strict=True):
            if parts[0].any():
                hand.ask("step", self._number, *parts)
                asked.append(hand)
        answers = _answers(asked)
        rest = iter(answers)
        return _joined([
            next(rest) if part.any() else _nothing_said(answers[0], len(part))
            for part in columns[0]
        ])  # fmt: skip


class _Here:
    """A desk in this process."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._answer: Any = None
        self.done_with: list[int] = []

    def ask(self, method: str, *arguments: Any) -> None:
        while self.done_with:
            self._desk.free(self.done_with.pop())
        self._answer = getattr(self._desk, method)(*arguments)

    def answer(self) -> Rows:
        found: Rows = self._answer
        return found


class _Worker:
    """A desk in a process of its own, which ends when nobody listens to it any more."""

    def __init__(self, opener: Opener, name: str) -> None:
        from loky.backend import get_context  # Its processes do not run the caller's script again.

        self._name = name
        context = get_context("loky")
        ours, theirs = context.Pipe()
        self._connection: Connection = ours
        self.done_with: list[int] = []
        self._process = context.Process(target=serve, args=(theirs, opener, name), daemon=True)
        self._process.start()
        theirs.close()
        weakref.finalize(self, ours.close)

    def ask(self, method: str, *arguments: Any) -> None:
        try:
            while self.done_with:
                self._connection.send(("free", (self.done_with.pop(),)))
            self._connection.send((method, arguments))
        except OSError:
            raise self._killed() from None

    def answer(self) -> Rows:
        try:
            error, found = self._connection.recv()
        except (EOFError, OSError):
            raise self._killed() from None
        if error is not None:
            raise UserError(error)
        rows: Rows = found
        return rows

    def _killed(self) -> UserError:
        return UserError(
            f"{self._name}: a process that steps its environments was killed, perhaps for want of "
            "memory: try fewer episodes at a time, or run the same command again"
        )


def _answers(hands: list[_Here | _Worker]) -> list[Rows]:
    """What all of them say; an error is raised when none has an answer left to give."""
    found: list[Rows] = []
    failed: list[UserError] = []
    for hand in hands:
        try:
            found.append(hand.answer())
        except UserError as error:
            failed.append(error)
    if failed:
        raise failed[0]
    return found


def _joined(parts: list[Rows]) -> Rows:
    return Rows(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _nothing_said(like: Rows, batch: int) -> Rows:
    """Rows of worlds that were not stepped."""
    return Rows(*(_zeros(column, batch) for column in like))


def _zeros(like: Shaped[np.ndarray, "B ..."], batch: int) -> Shaped[np.ndarray, "b ..."]:
    return np.zeros((batch, *like.shape[1:]), like.dtype)


def _cores() -> int:
    from rigid.compute.processes import cores

    return len(cores())

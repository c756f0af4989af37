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

from rigid.cores import cores, count_helper
from rigid.errors import UserError
from rigid.tasks.bridges.desk import Desk, Rows, Sizes, serve
from rigid.tasks.bridges.playing import Opener

FEWEST = 8
"""Worlds for which another process is worth its messages. Ours: a message takes about 0.1 ms, a
step of a small environment as long."""


class Pool:
    """The environments of one task; they stay open until the task is gone."""

    def __init__(self, opener: Opener, name: str, sizes: Sizes) -> None:
        self._opener, self._name, self._sizes = opener, name, sizes
        self._here: _Here | None = None
        self._workers: list[_Worker] = []
        self._numbers = count()

    def lease(self, batch: int, threads: int) -> Lease:
        """So many worlds; processes that are of no use any more are replaced.

        Args:
            batch: How many.
            threads: Processes that step them; 0: one for every core.
        """
        processes = min(threads or len(cores()), max(batch // FEWEST, 1))
        if processes == 1:
            if self._here is None or self._here.broken:
                self._here = _Here(Desk(self._opener, self._name, self._sizes))
            hands: list[_Here | _Worker] = [self._here]
        else:
            self._workers = [worker for worker in self._workers if not worker.broken]
            while len(self._workers) < processes:
                self._workers.append(_Worker(self._opener, self._name, self._sizes))
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
        return _joined(_told([
            (hand, ("reset", self._number, part))
            for hand, part in zip(self._hands, parts, strict=True)
        ]))  # fmt: skip

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
        answers = _told([
            (hand, ("step", self._number, *parts))
            for hand, *parts in zip(self._hands, *columns, strict=True)
            if parts[0].any()
        ])  # fmt: skip
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
        self.broken = False

    def ask(self, method: str, *arguments: Any) -> None:
        while self.done_with:
            self._desk.free(self.done_with.pop())
        self._answer = getattr(self._desk, method)(*arguments)

    def answer(self) -> Rows:
        found: Rows = self._answer
        return found

    def drop(self) -> None:
        """Lends nothing any more: an environment may have been left in the middle of a step."""
        self.broken = True


class _Worker:
    """A desk in a process of its own, which ends when nobody listens to it any more."""

    def __init__(self, opener: Opener, name: str, sizes: Sizes) -> None:
        from loky.backend import get_context  # Its processes do not run the caller's script again.

        self._name = name
        context = get_context("loky")
        ours, theirs = context.Pipe()
        self._connection: Connection = ours
        self.done_with: list[int] = []
        arguments = (theirs, opener, name, sizes)
        self._process = context.Process(target=serve, args=arguments, daemon=True)
        self._process.start()
        count_helper(self._process.pid)
        theirs.close()
        weakref.finalize(self, ours.close)

    @property
    def broken(self) -> bool:
        """Whether nobody listens there any more."""
        return self._connection.closed or not self._process.is_alive()

    def drop(self) -> None:
        """Listens no more: what it still answers would be taken for that to the next question."""
        self._connection.close()

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


def _told(questions: list[tuple[_Here | _Worker, tuple[Any, ...]]]) -> list[Rows]:
    """What all of them say, asked before any is heard.

    Raises:
        UserError: An environment fails, or its process was killed. No answer is left to be heard.
    """
    found: list[Rows] = []
    failed: list[UserError] = []
    asked: list[_Here | _Worker] = []
    try:
        for hand, question in questions:
            asked.append(hand)
            hand.ask(*question)
        for hand in asked:
            try:
                found.append(hand.answer())
            except UserError as error:
                failed.append(error)
    except BaseException:  # Interrupted, or one was killed: the others' answers must not stay.
        for hand in asked:
            hand.drop()
        raise
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

"""The environments of one process: opened, seeded and stepped one after the other."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from multiprocessing.connection import Connection
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped

from rigid.errors import UserError
from rigid.factories import told
from rigid.tasks.bridges.playing import Glimpse, Opener, Playable


class Rows(NamedTuple):
    """What the worlds of a lease said; rows of worlds that were not stepped are 0."""

    robot: Float[np.ndarray, "B r"]
    human: Float[np.ndarray, "B h"]
    features: Float[np.ndarray, "B f"]
    reward: Float[np.ndarray, " B"]
    ended: Bool[np.ndarray, " B"]
    success: Float[np.ndarray, " B"]


class Sizes(NamedTuple):
    """How many numbers every environment of a task shows, at every step."""

    robot: int
    human: int
    features: int


class _Lease:
    """Environments that play one set of episodes."""

    def __init__(self, worlds: list[Playable]) -> None:
        self.worlds = worlds
        self.seeds: Int[np.ndarray, " B"] = np.zeros(len(worlds), int)
        self.time = 0


class Desk:
    """Opens environments when they are first needed, and lends them out again when they are free.

    An environment is slow to open, while an episode depends on its seed alone.
    """

    def __init__(self, opener: Opener, name: str, sizes: Sizes) -> None:
        self._opener, self._name, self._sizes = opener, name, sizes
        self._spare: list[Playable] = []
        self._leases: dict[int, _Lease] = {}

    def reset(self, lease: int, seeds: Int[np.ndarray, " B"]) -> Rows:
        """Begins an episode in every world of a lease; a new one takes as many as there are seeds.

        Raises:
            UserError: The environment fails.
        """
        with _quiet():
            if lease not in self._leases:
                self._leases[lease] = _Lease([self._take() for _ in seeds])
            held = self._leases[lease]
            held.seeds, held.time = seeds, 0

            def begin(row: int) -> Glimpse:
                return held.worlds[row].reset(int(seeds[row]))

            return self._each(held, list(range(len(seeds))), begin)

    def step(
        self,
        lease: int,
        running: Bool[np.ndarray, " B"],
        robot: Shaped[np.ndarray, "B a_r"],
        human: Shaped[np.ndarray, "B a_h"],
    ) -> Rows:
        """Advances those worlds of a lease that are running, of which there must be one at least.

        Raises:
            UserError: The environment fails.
        """
        held = self._leases[lease]
        held.time += 1

        def advance(row: int) -> Glimpse:
            return held.worlds[row].step(robot[row], human[row])

        with _quiet():
            return self._each(held, np.flatnonzero(running).tolist(), advance)

    def free(self, lease: int) -> None:
        """Takes a lease's environments back."""
        held = self._leases.pop(lease, None)
        if held is not None:
            self._spare += held.worlds

    def _take(self) -> Playable:
        return self._spare.pop() if self._spare else self._opener()

    def _each(self, held: _Lease, rows: list[int], act: Callable[[int], Glimpse]) -> Rows:
        said = {row: self._guarded(held, row, act) for row in rows}
        found = _blank(len(held.worlds), self._sizes)
        for row, glimpse in said.items():
            for column, value in zip(found, glimpse, strict=True):
                column[row] = value
        return found

    def _guarded(self, held: _Lease, row: int, act: Callable[[int], Glimpse]) -> Glimpse:
        try:
            return self._fitting(act(row))
        except UserError:
            raise
        except Exception as error:  # noqa: BLE001 - Somebody else's code may raise anything.
            when = f"at step {held.time}" if held.time else "at the reset"
            raise UserError(
                f"{self._name}: the environment fails {when} of the episode of seed "
                f"{held.seeds[row]}: {told(error)}"
            ) from None

    def _fitting(self, glimpse: Glimpse) -> Glimpse:
        """What an environment said, if it is as large as at its first reset."""
        shown = (glimpse.robot, glimpse.human, glimpse.features)
        whose = ("the robot", "the human", "naturalness")
        for who, numbers, size in zip(whose, shown, self._sizes, strict=True):
            if np.shape(numbers) != (size,):
                raise ValueError(
                    f"it shows {who} {np.size(numbers)} numbers, but began with {size}"
                )
        return glimpse


def _blank(batch: int, sizes: Sizes) -> Rows:
    robot, human, features = (np.zeros((batch, size), np.float32) for size in sizes)
    return Rows(
        robot, human, features,
        np.zeros(batch), np.zeros(batch, bool), np.full(batch, np.nan),
    )  # fmt: skip


@contextmanager
def _quiet() -> Iterator[None]:
    """What environments print must not get between the lines of a command's result."""
    with redirect_stdout(sys.stderr):
        yield


def serve(connection: Connection, opener: Opener, name: str, sizes: Sizes) -> None:
    """What a worker process does until whoever started it is gone: answers, one after the other.

    Args:
        connection: Gives (method of `Desk`, arguments), takes (None or the error's text, answer);
            `free` has no answer.
        opener: Opens environments here.
        name: Of the task, for messages.
        sizes: Of what its environments show.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # The interrupted parent closes the connection.
    desk = Desk(opener, name, sizes)
    try:
        while True:
            method, arguments = connection.recv()
            if method == "free":
                desk.free(*arguments)
                continue
            try:
                answer = (None, getattr(desk, method)(*arguments))
            except UserError as error:
                connection.send((str(error), None))
            except Exception as error:  # noqa: BLE001 - Whoever asked has to hear of it.
                connection.send((f"{name}: {told(error)}", None))
            else:
                connection.send(answer)
    except (EOFError, OSError):  # Nobody is there any more.
        return

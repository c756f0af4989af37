"""How much work is left: what each part is expected to take, and how far it is."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

from benchmarks.standard.making import Workplace
from benchmarks.standard.plan import Part
from rigid.compute.executors.executor import Executor
from rigid.compute.executors.processes import Processes
from rigid.cores import cores
from rigid.presets import Preset

_ROBOT_SECONDS = 6.0
"""Compilation and canonical episodes of a robot; for the estimate of time only (measured)."""
_PART_SECONDS = 8.0
"""Canonical play and the passive human of a measurement; for the estimate of time only (measured).
"""
GAIN_OF_PROCESSES = 1.4
"""Work of a process for each core, over that of one process on all of them (measured on two)."""
_SCORING_SECONDS = 2.0
"""Playing and judging one adversary; for the estimate of time only (measured)."""


def training_seconds(place: Workplace, speed: float) -> float:
    """How long the robots take that are yet to be trained [s], at `speed` steps per second."""
    episodes, horizon = place.plan.recipe.episodes, place.task.horizon
    return sum(
        _ROBOT_SECONDS + robot.training.iterations * episodes * horizon / speed
        for robot in place.untrained() if robot.training is not None
    )  # fmt: skip


def search_seconds(preset: Preset, horizon: int, speed: float) -> float:
    """How long one worker searches a part [s].

    Args:
        preset: Budget of the part.
        horizon: Steps of an episode.
        speed: Training steps per second of the worker.
    """
    return preset.adversaries * _SCORING_SECONDS + preset.env_steps(horizon) / speed


class Work:
    """The parts that are missing."""

    def __init__(
        self,
        shares: Mapping[Part, float],
        search: Mapping[str, float],
        *,
        workers: int,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        """Time runs from now on.

        Args:
            shares: How much of each part's search is done already, in [0, 1].
            search: From `search_seconds`, by preset.
            workers: Parts that are measured side by side.
            now: The time [s], from any start.
        """
        self._shares, self._search, self._workers, self._now = (
            dict(shares), search, workers, now,
        )  # fmt: skip
        self._begun: set[Part] = set()
        self._finished = False
        self._start, self._first = now(), self.expected

    @property
    def expected(self) -> float:
        """What was expected for all that is left [s], before anything was seen."""
        return sum(map(self._of, self._shares)) / self._workers

    @property
    def parts(self) -> int:
        """How many are not finished."""
        return len(self._shares)

    @property
    def left(self) -> float:
        """An estimate of what is left [s], corrected by how long the work so far took."""
        return self.expected * self._pace

    def begin(self, part: Part) -> None:
        """A part is under way."""
        self._begun.add(part)

    def advance(self, part: Part, share: float) -> None:
        """So much of its search is done, in [0, 1]; never less than before."""
        self._shares[part] = max(self._shares[part], share)

    def finish(self, part: Part) -> None:
        """It is measured."""
        del self._shares[part]
        self._begun.discard(part)
        self._finished = True

    def seconds_with(self, part: Part) -> float:
        """When a part would be finished if it was begun now, and all that is under way [s]."""
        begun = sum(self._of(one) for one in {*self._begun, part})
        return self._pace * max(self._of(part), begun / self._workers)

    @property
    def _pace(self) -> float:
        """How much longer than expected it takes; known once a part is finished."""
        done = self._first - self.expected
        return (self._now() - self._start) / done if self._finished and done > 0 else 1.0

    def _of(self, part: Part) -> float:
        """What a part still takes its worker [s]."""
        return _PART_SECONDS + self._search[part.preset] * (1 - self._shares[part])


def work_of(place: Workplace, parts: Sequence[Part], executor: Executor, speed: float) -> Work:
    """The work of parts.

    Args:
        place: Where they lie.
        parts: Those that are missing.
        executor: Who does it.
        speed: Training steps per second of this process, on every core.
    """
    workers = executor.count if isinstance(executor, Processes) else 1
    if workers > 1:
        speed *= GAIN_OF_PROCESSES / len(cores())
    plan, horizon = place.plan, place.task.horizon
    return Work(
        {part: place.searched_share(part) for part in parts},
        {name: search_seconds(plan.search(name), horizon, speed) for name in plan.presets()},
        workers=workers,
    )  # fmt: skip

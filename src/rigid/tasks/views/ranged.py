"""A task with another range of adversarialness than its own, or with one where it has none."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.errors import UserError
from rigid.tasks.protocol import Step, Task, World

_OPTIONAL = (
    "builtin_policies", "shown_human", "diversified", "human_poses", "control_period",
    "feature_units", "bounds",
)  # fmt: skip
"""Members of the protocols that a task may keep besides `Task`. `isinstance` looks for them among
an object's own attributes, so that passing them on when they are asked for would not do."""


def with_range(task: Task, range_: Sequence[float]) -> Task:
    """`task` with another range of adversarialness; in everything else it is the same task.

    Args:
        task: Any task.
        range_: The returns (worst, best) that map to adversarialness 1 and 0.

    Raises:
        UserError: They are not finite, or `worst` is not below `best`.

    Example:
        >>> from rigid.tasks.registry import make_task
        >>> with_range(make_task("analytic/hand-tracking"), (-10, 0)).return_range
        (-10.0, 0.0)
    """
    return _RangedTask(task, checked_range(range_))


def checked_range(range_: Sequence[float]) -> tuple[float, float]:
    """(worst, best) as numbers.

    Raises:
        UserError: They are not finite, or `worst` is not below `best`.
    """
    worst, best = (float(value) for value in range_)
    if not (math.isfinite(worst) and math.isfinite(best) and worst < best):
        raise UserError(
            f"the range of adversarialness is {worst:g},{best:g}, but must be two returns LOW,HIGH "
            "with LOW < HIGH: the one that maps to 1 comes first"
        )
    return worst, best


class _RangedTask:
    """A task, but for its range."""

    def __init__(self, task: Task, range_: tuple[float, float]) -> None:
        self._task = task
        self.name, self.horizon = task.name, task.horizon
        self.robot, self.human = task.robot, task.human
        self.feature_names, self.outcome_names = task.feature_names, task.outcome_names
        self.return_range: tuple[float, float] | None = range_
        for name in _OPTIONAL:
            if hasattr(task, name):
                setattr(self, name, getattr(task, name))

    def __getattr__(self, name: str) -> Any:
        """Whatever else the task has; what is private or special is its own affair."""
        if name.startswith("_"):  # Also while it is unpickled, when there is no task yet.
            raise AttributeError(name)
        return getattr(self._task, name)

    def make_world(self, batch: int, *, threads: int = 0) -> World:
        return self._task.make_world(batch, threads=threads)

    def features(self, step: Step) -> Float[np.ndarray, "B features"]:
        return self._task.features(step)

    def scene(self) -> Mapping[str, Any] | None:
        return self._task.scene()

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        return self._task.replay(snapshots)

    def describe(self) -> Mapping[str, Any]:
        return self._task.describe()

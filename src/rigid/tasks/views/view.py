"""A task that is the same task in all but what a view of it replaces."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.tasks.protocol import Step, Task, World

_OPTIONAL = (
    "builtin_policies", "shown_human", "diversified", "human_poses", "control_period",
    "feature_units", "bounds", "most_worlds",
)  # fmt: skip
"""Members of the protocols that a task may keep besides `Task`. `isinstance` looks for them among
an object's own attributes, so that passing them on when they are asked for would not do."""


class TaskView:
    """The task itself; whoever derives from it replaces a part."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self.name, self.horizon = task.name, task.horizon
        self.robot, self.human = task.robot, task.human
        self.feature_names, self.outcome_names = task.feature_names, task.outcome_names
        self.return_range: tuple[float, float] | None = task.return_range
        for name in _OPTIONAL:
            if hasattr(task, name):
                setattr(self, name, getattr(task, name))

    def __getattr__(self, name: str) -> Any:
        """Whatever else the task has; what is private or special is its own affair."""
        if name.startswith("_"):  # Also while it is unpickled, when there is no task yet.
            raise AttributeError(name)
        return getattr(self._task, name)

    def make_world(self, batch: int, *, threads: int = 0) -> World:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""
        return self._task.make_world(batch, threads=threads)

    def features(self, step: Step) -> Float[np.ndarray, "B features"]:
        """What naturalness sees of the human."""
        return self._task.features(step)

    def scene(self) -> Mapping[str, Any] | None:
        """As the task's."""
        return self._task.scene()

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """As the task's."""
        return self._task.replay(snapshots)

    def describe(self) -> Mapping[str, Any]:
        """As the task's: it is the same task."""
        return self._task.describe()

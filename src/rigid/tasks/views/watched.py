"""Worlds that tell how many steps were done, since an iteration of a slow task takes minutes."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.protocol import Step, Summary, Task, World
from rigid.tasks.views.view import TaskView

Tell = Callable[[int], None]
"""Told of environment steps since the last call."""

_SECONDS = 5.0
"""Between two calls at least: a bar that stands still for longer looks stuck, and somebody who
writes to disk when told should not do so at every control step. Ours."""


class WatchedWorld:
    """B worlds that tell of their steps, a while after the first one and then now and then."""

    def __init__(self, world: World, tell: Tell, seconds: float = _SECONDS) -> None:
        self.batch = world.batch
        self._world, self._tell, self._seconds = world, tell, seconds
        self._untold, self._last = 0, time.monotonic()

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """As the worlds do."""
        if not self._untold:  # What was done between two episodes is no time of a step.
            self._last = time.monotonic()
        return self._world.reset(seeds)

    def step(
        self, robot_action: Float[np.ndarray, "B a_r"], human_action: Float[np.ndarray, "B a_h"]
    ) -> Step:
        """As the worlds do."""
        after = self._world.step(robot_action, human_action)
        self._untold += self.batch
        if time.monotonic() - self._last >= self._seconds:
            self.tell_all()
        return after

    def tell_all(self) -> None:
        """Tells of the steps that were not told yet."""
        if self._untold:
            self._tell(self._untold)
        self._untold, self._last = 0, time.monotonic()

    def summary(self) -> Summary:
        """As the worlds do."""
        return self._world.summary()

    def snapshot(self) -> Float[np.ndarray, "B state"]:
        """As the worlds do."""
        return self._world.snapshot()


class _WatchedTask(TaskView):
    def __init__(self, task: Task, tell: Tell, seconds: float) -> None:
        super().__init__(task)
        self._tell, self._seconds = tell, seconds

    def make_world(self, batch: int, *, threads: int = 0) -> World:
        return WatchedWorld(super().make_world(batch, threads=threads), self._tell, self._seconds)


def watched(task: Task, tell: Tell, seconds: float = _SECONDS) -> Task:
    """The same task, in which whoever plays or trains tells of steps as they are done.

    Args:
        task: Any task. What it reveals or diversifies is another task, which tells nothing.
        tell: Told, so that of the last steps of a world nobody hears.
        seconds: Between two calls at least.
    """
    return _WatchedTask(task, tell, seconds)

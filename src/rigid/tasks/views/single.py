"""One world of a task, unbatched: boxes, checked actions and plain numbers, for every view."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium import spaces
from jaxtyping import Float, Float32

from rigid.tasks.protocol import BoundedTask, Step, Task

AGENTS = ("robot", "human")


class SingleWorld:
    """Plays one episode at a time."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.observation_spaces = {agent: _observation_box(task, agent) for agent in AGENTS}
        self.action_spaces = {agent: _action_box(task, agent) for agent in AGENTS}
        self._world = task.make_world(1, threads=1)
        self._step: Step | None = None
        self._time = 0

    @property
    def over(self) -> bool:
        """Whether the episode has had its full length, or has not begun."""
        return self._step is None or self._time >= self.task.horizon

    def reset(self, seed: int) -> None:
        """Begins the episode that `seed` starts in any world of the task."""
        self._step, self._time = self._world.reset(np.array([seed])), 0

    def step(self, actions: Mapping[str, np.ndarray]) -> float:
        """Advances one control step; returns the shared reward.

        Raises:
            ValueError: The episode is over, or an action is missing, not finite or of another
                shape than its space.
        """
        if self.over:
            raise ValueError("step: no episode is under way: call reset")
        robot, human = (self._checked(actions, agent) for agent in AGENTS)
        self._step, self._time = self._world.step(robot, human), self._time + 1
        return float(self._step.reward[0])

    def unclipped(self, agent: str) -> Float[np.ndarray, "1 n"]:
        """What `agent` sees, as policies of RIGID get it."""
        if self._step is None:
            raise ValueError("unclipped: no episode is under way: call reset")
        step = self._step
        return step.robot_observation if agent == "robot" else step.human_observation

    def observation(self, agent: str) -> Float32[np.ndarray, " n"]:
        """What `agent` sees, clipped to the box of its space."""
        box = self.observation_spaces[agent]
        clipped: np.ndarray = np.clip(self.unclipped(agent)[0], box.low, box.high)
        return clipped

    def info(self) -> dict[str, Any]:
        """The step's named reward terms and measurements, and how the episode stands so far.

        `is_success`, `outcome`, `peak_force` [N], `impulse` [N s] and the task's counts are final
        once the episode is over. A fresh dictionary of plain Python numbers at every call.
        """
        if self._step is None:
            return {}
        summary = self._world.summary()
        measured = {**self._step.info, **summary.extra}
        return {
            **{name: values[0].item() for name, values in measured.items()},
            "is_success": bool(summary.success[0] == 1),
            "outcome": self.task.outcome_names[int(summary.outcome[0])],
            "peak_force": float(summary.peak_force[0]),
            "impulse": float(summary.impulse[0]),
            "faulted": bool(self._step.faulted[0]),
        }

    def _checked(self, actions: Mapping[str, np.ndarray], agent: str) -> Float[np.ndarray, "1 a"]:
        if agent not in actions:
            raise ValueError(f"actions has none for {agent!r}, only for {sorted(actions)}")
        action = np.asarray(actions[agent], dtype=np.float64)
        shape = self.action_spaces[agent].shape
        if action.shape != shape:
            raise ValueError(f"actions[{agent!r}] has shape {action.shape}, but must have {shape}")
        if not np.isfinite(action).all():
            raise ValueError(f"actions[{agent!r}] is not finite: {action}")
        return action[None]


def _observation_box(task: Task, agent: str) -> spaces.Box:
    if isinstance(task, BoundedTask):
        low, high = task.bounds(agent).T.astype(np.float32)
        return spaces.Box(low, high, dtype=np.float32)
    size = {"robot": task.robot, "human": task.human}[agent].observation_size
    return spaces.Box(-np.inf, np.inf, (size,), dtype=np.float32)


def _action_box(task: Task, agent: str) -> spaces.Box:
    size = {"robot": task.robot, "human": task.human}[agent].action_size
    return spaces.Box(-1.0, 1.0, (size,), dtype=np.float32)

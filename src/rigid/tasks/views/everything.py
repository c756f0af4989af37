"""A task whose robot also sees all that the human sees: an upper bound for any real robot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.protocol import (
    AgentSpec,
    BoundedTask,
    Step,
    Summary,
    Task,
    World,
    control_period,
    feature_units,
)


class SeeingEverything:
    """`task` with the human's observation appended to the robot's."""

    def __init__(self, task: Task) -> None:
        self.inner = task
        self.name, self.horizon, self.human = task.name, task.horizon, task.human
        self.feature_names, self.outcome_names = task.feature_names, task.outcome_names
        self.return_range = task.return_range
        self.control_period = control_period(task)
        self.feature_units = feature_units(task)
        self.robot = AgentSpec(
            task.robot.observation_size + task.human.observation_size,
            task.robot.action_size,
            choices=task.robot.choices,
        )
        if isinstance(task, BoundedTask):
            human = task.bounds("human")
            both = np.concatenate([task.bounds("robot"), human])
            self.bounds = {"robot": both, "human": human}.__getitem__

    def make_world(self, batch: int, *, threads: int = 0) -> World:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""
        return _SeeingWorld(self.inner.make_world(batch, threads=threads))

    def features(self, step: Step) -> Float[np.ndarray, "B features"]:
        """What naturalness sees of the human."""
        return self.inner.features(step)

    def scene(self) -> Mapping[str, Any] | None:
        """As the task's."""
        return self.inner.scene()

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """As the task's."""
        return self.inner.replay(snapshots)

    def describe(self) -> Mapping[str, Any]:
        """The task's description, marked."""
        return {**self.inner.describe(), "robot_sees": "everything"}


class _SeeingWorld:
    def __init__(self, world: World) -> None:
        self._world, self.batch = world, world.batch

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        return _seeing(self._world.reset(seeds))

    def step(
        self, robot_action: Float[np.ndarray, "B a_r"], human_action: Float[np.ndarray, "B a_h"]
    ) -> Step:
        return _seeing(self._world.step(robot_action, human_action))

    def summary(self) -> Summary:
        return self._world.summary()

    def snapshot(self) -> Float[np.ndarray, "B state"]:
        return self._world.snapshot()


def _seeing(step: Step) -> Step:
    both = np.concatenate([step.robot_observation, step.human_observation], axis=1)
    return step._replace(robot_observation=both)

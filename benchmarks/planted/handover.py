"""Hand-over: the human brings a hand to a place of its choice, and the robot comes to meet it.

Only the human knows its intention: where to meet, how quickly, and by how wide a curve. A robot
that follows the hand meets every natural motion; only a hand out of its reach escapes it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.protocol import AgentSpec, Step, Summary

HORIZON = 40
"""Steps of an episode: 4 s at 10 Hz. Ours, like every number of this task."""
HAND_STEP, ROBOT_STEP = 0.08, 0.06
"""Farthest that hand and robot move in a step [m]."""
INERTIA = 0.5
"""Share of the hand's movement that carries over into the next step."""
ROBOT_HOME = (0.0, 1.0, 0.0)
"""Across, along and up, seen from the person [m]."""
REACH_CENTRE, REACH = (0.0, 0.6, 0.0), 0.7
"""The robot stays within this distance of this point [m]."""
TOGETHER = 0.06
"""Hand and robot have met within this distance [m]."""
MEETING_STEPS = 10
"""Steps together that make a hand-over."""
FAR = 0.5
"""Distance from which on it makes no further difference to the reward [m]."""
INTENTION = ("across", "along", "up", "hurry", "curve")


class HandOver:
    """The shared reward of a step is minus the distance of hand and robot, 1 from `FAR` on."""

    name = "planted/hand-over"
    version = 0
    horizon = HORIZON
    robot = AgentSpec(
        9, 3, tuple(f"{of}_{axis}" for of in ("hand", "move", "robot") for axis in "xyz")
    )
    human = AgentSpec(14, 3, (*robot.observation_names, *INTENTION))
    feature_names: tuple[str, ...] = robot.observation_names[:6]
    outcome_names: tuple[str, ...] = ("met", "missed")
    return_range: tuple[float, float] | None = (-40.0, -8.0)
    """Apart all the time, and canonical play with a robot that follows (measured: -7.9)."""

    def make_world(self, batch: int, *, threads: int = 0) -> HandOverWorld:
        """Returns `batch` worlds; they are arithmetic, so `threads` is ignored."""
        del threads
        return HandOverWorld(batch)

    def features(self, step: Step) -> Float[np.ndarray, "B 6"]:
        """Hand and its last movement [m]; nothing of the robot or the intention."""
        return step.features

    def scene(self) -> None:
        """Nothing to draw."""

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Nothing to show."""
        del snapshots
        return {}

    def describe(self) -> Mapping[str, Any]:
        """Name and version, as JSON."""
        return {"name": self.name, "version": self.version}


class HandOverWorld:
    """B hand-overs."""

    def __init__(self, batch: int) -> None:
        self.batch = batch
        self._begin(np.zeros(batch, dtype=np.int64))

    def _begin(self, seeds: Int[np.ndarray, " B"]) -> None:
        drawn = np.stack([np.random.default_rng(int(seed)).standard_normal(8) for seed in seeds])
        self._intention = drawn[:, :5]
        self._hand = 0.02 * drawn[:, 5:]
        self._move = np.zeros((self.batch, 3))
        self._robot = np.tile(np.array(ROBOT_HOME), (self.batch, 1))
        self._together = np.zeros(self.batch, dtype=np.int64)

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Draws where the hand starts, and what the human intends."""
        self._begin(seeds)
        return self._look(np.zeros(self.batch))

    def step(
        self, robot_action: Float[np.ndarray, "B 3"], human_action: Float[np.ndarray, "B 3"]
    ) -> Step:
        """Both move at once."""
        wanted = HAND_STEP * np.clip(human_action, -1, 1)
        self._move = INERTIA * self._move + (1 - INERTIA) * wanted
        self._hand = self._hand + self._move
        self._robot = within_reach(self._robot + ROBOT_STEP * np.clip(robot_action, -1, 1))
        apart = np.linalg.norm(self._hand - self._robot, axis=1)
        self._together += apart < TOGETHER
        return self._look(-np.minimum(apart / FAR, 1.0))

    def summary(self) -> Summary:
        """Whether they met."""
        met = self._together >= MEETING_STEPS
        none = np.zeros(self.batch)
        return Summary(met.astype(np.float64), np.where(met, 0, 1), none, none, {})

    def snapshot(self) -> Float[np.ndarray, "B 0"]:
        """Nothing to show."""
        return np.zeros((self.batch, 0))

    def _look(self, reward: Float[np.ndarray, " B"]) -> Step:
        seen = np.concatenate([self._hand, self._move, self._robot], axis=1)
        return Step(
            seen.astype(np.float32),
            np.concatenate([seen, self._intention], axis=1).astype(np.float32),
            reward,
            seen[:, :6].astype(np.float32),
            np.zeros(self.batch, dtype=bool),
            {"apart": -reward * FAR},
        )


def within_reach(places: Float[np.ndarray, "B 3"]) -> Float[np.ndarray, "B 3"]:
    """Places [m], those beyond the robot's reach drawn back to its edge."""
    offset = places - np.array(REACH_CENTRE)
    distance = np.linalg.norm(offset, axis=1, keepdims=True)
    kept = offset * np.minimum(1.0, REACH / np.maximum(distance, 1e-9))
    return np.asarray(np.array(REACH_CENTRE) + kept)

"""Offset catch: the human hands something over, off centre; the robot catches it or does not.

One step. The human draws an offset x from N(m, 1); canonical play has m = 0. It is the smallest
task on which a frontier exists, and every quantity of its frontier has a closed form
(`rigid.tasks.analytic.mean_shift`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, get_args

import numpy as np
from jaxtyping import Float, Int

from rigid.errors import UserError
from rigid.policies.gaussian import GaussianPolicy
from rigid.tasks.analytic.policies import linear_policy, noise_policy
from rigid.tasks.protocol import AgentSpec, Step, Summary

Cost = Literal["linear", "failure"]

REACH = 8.0
"""Offset of a full action, in canonical standard deviations: an action is x / 8 and its canonical
noise 1/8. The task clips actions to [-1, 1], so the law of x is Gaussian only far from ±8: a shift
of 2.5, larger than any finite optimum of the default penalty, is clipped once in 5e7 draws. Only
λ = 0, which has no optimum, reaches the end. Ours."""


class OffsetCatch:
    """The human draws an offset, the robot holds its hand still, and the shared reward is -cost.

    Cost `linear` is x - r and `failure` is 1 where x - r > tolerance, else 0; r is where the robot
    holds its hand. Features: x alone.
    """

    name = "analytic/offset-catch"
    version = 0
    horizon = 1
    robot = AgentSpec(1, 1, ("nothing",))
    human = AgentSpec(1, 1, ("nothing",))
    feature_names: tuple[str, ...] = ("offset",)
    outcome_names: tuple[str, ...] = ("caught", "missed")

    def __init__(self, cost: str = "linear", tolerance: float = 2.0) -> None:
        """Builds the task.

        Args:
            cost: `linear` has an interior optimum for every λ; `failure` is what a frontier shows.
            tolerance: How far off centre the robot still catches, in canonical deviations.

        Raises:
            UserError: Unknown cost, or a tolerance that is not between 0 and 8.
        """
        if cost not in get_args(Cost):
            known = ", ".join(get_args(Cost))
            raise UserError(f"{self.name}: cost is {cost!r}, but must be one of {known}")
        if not 0 <= tolerance < REACH:
            raise UserError(
                f"{self.name}: tolerance is {tolerance}, but must be at least 0 and less than "
                f"{REACH:g}, the farthest offset"
            )
        self.cost, self.tolerance = cost, float(tolerance)
        # λ = 0 drives x to 8, and canonical x has mean 0; a miss is a miss.
        self.return_range: tuple[float, float] | None = (
            (-REACH, 0.0) if cost == "linear" else (-1.0, 0.0)
        )

    def make_world(self, batch: int, *, threads: int = 0) -> OffsetCatchWorld:
        """Returns `batch` worlds; they are arithmetic, so `threads` is ignored."""
        del threads
        return OffsetCatchWorld(self, batch)

    def features(self, step: Step) -> Float[np.ndarray, "B 1"]:
        """The offset x."""
        return step.features

    def builtin_policies(self, agent: Literal["robot", "human"]) -> Mapping[str, GaussianPolicy]:
        """`catcher` holds still at the centre; `synthetic-human` draws from N(0, 1)."""
        if agent == "robot":
            return {"catcher": linear_policy(np.zeros((1, 1)))}
        return {"synthetic-human": noise_policy(np.array([1 / REACH]), np.ones(1))}

    def scene(self) -> None:
        """Nothing to draw."""

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Nothing to show."""
        del snapshots
        return {}

    def describe(self) -> Mapping[str, Any]:
        """Name, version and parameters, as JSON."""
        parameters = {"cost": self.cost, "tolerance": self.tolerance}
        return {"name": self.name, "version": self.version, "parameters": parameters}


class OffsetCatchWorld:
    """B hand-overs."""

    def __init__(self, task: OffsetCatch, batch: int) -> None:
        self.batch, self._task = batch, task
        self._offset = self._hand = np.zeros(batch)

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Every start is alike, whatever the seeds."""
        del seeds
        self._offset = self._hand = np.zeros(self.batch)
        return self._look(np.zeros(self.batch))

    def step(
        self, robot_action: Float[np.ndarray, "B 1"], human_action: Float[np.ndarray, "B 1"]
    ) -> Step:
        """The hand-over."""
        self._offset, self._hand = (
            REACH * np.clip(action[:, 0], -1.0, 1.0).astype(np.float64)
            for action in (human_action, robot_action)
        )
        miss = self._offset - self._hand
        return self._look(-miss if self._task.cost == "linear" else -self._missed())

    def summary(self) -> Summary:
        """Success is a catch, whatever the cost; there are no forces."""
        missed, unknown = self._missed(), np.full(self.batch, np.nan)
        return Summary(1 - missed, missed.astype(np.int64), unknown, unknown, {})

    def snapshot(self) -> Float[np.ndarray, "B 0"]:
        """Nothing to show."""
        return np.zeros((self.batch, 0))

    def _missed(self) -> Float[np.ndarray, " B"]:
        missed: np.ndarray = self._offset - self._hand > self._task.tolerance
        return missed.astype(np.float64)

    def _look(self, reward: Float[np.ndarray, " B"]) -> Step:
        nothing = np.zeros((self.batch, 1), np.float32)
        features = self._offset[:, np.newaxis].astype(np.float32)
        faulted = np.zeros(self.batch, dtype=bool)
        return Step(nothing, nothing, reward, features, faulted, {"missed": self._missed()})

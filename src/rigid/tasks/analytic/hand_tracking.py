"""Hand tracking: the robot follows a hand that wanders; a linear system with a quadratic cost.

Each step the robot makes up for the share k of the error that it sees, and the human moves:

    e' = (1 - k) e + a,   a ~ N(0, 0.01) in canonical play,   cost Σ e'²  over T = 20 steps.

The most adversarial human at a given KL divergence is a linear feedback a = K e + noise, known
exactly (`rigid.tasks.analytic.linear_quadratic`): a test of everything that has more than one step.
The human sees the error and no clock, so that its gain K is one number.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from jaxtyping import Float, Int

from rigid.errors import UserError
from rigid.policies.gaussian import GaussianPolicy
from rigid.tasks.analytic.policies import linear_policy, noise_policy
from rigid.tasks.protocol import AgentSpec, Step, Summary

HORIZON = 20
NOISE = 0.1
"""Standard deviation of a canonical movement, s."""
REACH = 2.0
"""Movement of a full action. The task clips actions to [-1, 1]: 2 is 20 canonical deviations, and
still 5 of them beyond the largest movements of an adversary at the edge of breakdown. Ours."""


class HandTracking:
    """The robot follows the human's hand; the shared reward is minus the squared error.

    Features: the error that the human answered and the movement it made, the pair on which the
    exact log-ratio of a step, log q(a | e) - log p(a), depends.
    """

    name = "analytic/hand-tracking"
    version = 0
    horizon = HORIZON
    robot = AgentSpec(1, 1, ("error",))
    human = AgentSpec(1, 1, ("error",))
    feature_names: tuple[str, ...] = ("error", "movement")
    outcome_names: tuple[str, ...] = ("ended",)
    return_range: tuple[float, float] | None = (-2.5, 0.0)
    """0 is perfect tracking. 1 is the cost that the slower robot of the tests, k = 0.2, pays at 1.1
    times the weight at which its optimum breaks down (exactly 2.54). Ours."""

    def __init__(self, gain: float = 0.5) -> None:
        """Builds the task.

        Args:
            gain: Share k of the error that `builtin:tracker` makes up for in a step.

        Raises:
            UserError: The gain is not between 0 and 1.
        """
        if not 0 < gain <= 1:
            raise UserError(f"{self.name}: gain is {gain}, but must be more than 0, at most 1")
        self.gain = float(gain)

    def make_world(self, batch: int, *, threads: int = 0) -> HandTrackingWorld:
        """Returns `batch` worlds; they are arithmetic, so `threads` is ignored."""
        del threads
        return HandTrackingWorld(batch)

    def features(self, step: Step) -> Float[np.ndarray, "B 2"]:
        """Error before the movement, and the movement."""
        return step.features

    def builtin_policies(self, agent: Literal["robot", "human"]) -> Mapping[str, GaussianPolicy]:
        """`tracker` moves by -k e; `synthetic-human` wanders."""
        if agent == "robot":
            return {"tracker": linear_policy(np.array([[-self.gain / REACH]]))}
        return {"synthetic-human": noise_policy(np.array([NOISE / REACH]), np.array([NOISE]))}

    def scene(self) -> None:
        """Nothing to draw."""

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Nothing to show."""
        del snapshots
        return {}

    def describe(self) -> Mapping[str, Any]:
        """Name, version and parameters, as JSON."""
        return {"name": self.name, "version": self.version, "parameters": {"gain": self.gain}}


class HandTrackingWorld:
    """B hands that wander."""

    def __init__(self, batch: int) -> None:
        self.batch = batch
        self._error = np.zeros(batch)

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Every start is alike, whatever the seeds: no error."""
        del seeds
        self._error = np.zeros(self.batch)
        return self._look(np.zeros((self.batch, 2)))

    def step(
        self, robot_action: Float[np.ndarray, "B 1"], human_action: Float[np.ndarray, "B 1"]
    ) -> Step:
        """Both move at once."""
        follows, moves = (
            REACH * np.clip(action[:, 0], -1.0, 1.0).astype(np.float64)
            for action in (robot_action, human_action)
        )
        pair = np.stack([self._error, moves], axis=1)
        self._error = self._error + follows + moves
        return self._look(pair)

    def summary(self) -> Summary:
        """The task defines neither success nor forces."""
        unknown = np.full(self.batch, np.nan)
        return Summary(unknown, np.zeros(self.batch, np.int64), unknown, unknown, {})

    def snapshot(self) -> Float[np.ndarray, "B 0"]:
        """Nothing to show."""
        return np.zeros((self.batch, 0))

    def _look(self, pair: Float[np.ndarray, "B 2"]) -> Step:
        error = self._error[:, np.newaxis].astype(np.float32)
        cost = self._error**2
        return Step(
            error, error, -cost, pair.astype(np.float32), np.zeros(self.batch, dtype=bool),
            {"squared_error": cost},
        )  # fmt: skip

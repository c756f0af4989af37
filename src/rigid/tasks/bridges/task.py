"""A task whose worlds are environments of somebody else's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.bridges.desk import Rows, Sizes
from rigid.tasks.bridges.padding import Moment, Padding
from rigid.tasks.bridges.playing import Opener, Rules
from rigid.tasks.bridges.pool import Lease, Pool
from rigid.tasks.protocol import AgentSpec, Step, Summary

OUTCOMES = ("ran its time", "ended early")
MOST_WORLDS = 128
"""Environments at a time where episodes are only played: a simulator that is not batched takes some
10 to 50 MB for each, and a group of adversaries is scored on a thousand episodes. Ours."""


class BridgeTask:
    """A task of environments that play one episode each.

    It has no range of adversarialness and nothing to show, and measures no forces. Success is the
    environment's own, NaN where it says nothing.
    """

    outcome_names: tuple[str, ...] = OUTCOMES
    most_worlds = MOST_WORLDS
    return_range: tuple[float, float] | None = None
    holds_after_end = True
    """See `rigid.naturalness.features.choose_features`."""

    def __init__(
        self, name: str, parameters: Mapping[str, Any], opener: Opener, rules: Rules, version: str
    ) -> None:
        """Builds the task.

        Args:
            name: As the user wrote it.
            parameters: What `make_task` takes besides, resolved; JSON.
            opener: Opens one more environment, in any process.
            rules: Of such an environment.
            version: Tells whether it is still the same one, as `source_fingerprint` does.
        """
        self.name, self.horizon = name, rules.horizon
        self.robot: AgentSpec = rules.robot
        self.human: AgentSpec = rules.human
        self.feature_names = rules.feature_names
        self.control_period = rules.control_period
        self._parameters, self._opener, self._version = dict(parameters), opener, version
        self._pool: Pool | None = None

    def __getstate__(self) -> dict[str, Any]:
        """Another process opens its own environments."""
        return {**self.__dict__, "_pool": None}

    def make_world(self, batch: int, *, threads: int = 0) -> BridgeWorld:
        """Returns `batch` worlds stepped by `threads` processes (0: one for each core)."""
        sees = (self.robot.observation_size, self.human.observation_size)
        sizes = Sizes(*sees, len(self.feature_names))
        self._pool = self._pool or Pool(self._opener, self.name, sizes)
        return BridgeWorld(self.horizon, self._pool.lease(batch, threads))

    def features(self, step: Step) -> Float[np.ndarray, "B features"]:
        """What naturalness sees of the human."""
        return step.features

    def scene(self) -> None:
        """Nothing to draw."""

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Nothing to show."""
        del snapshots
        return {}

    def describe(self) -> Mapping[str, Any]:
        """Name, fingerprint and parameters, as JSON: a factory that was edited is another task."""
        return {"name": self.name, "version": self._version, "parameters": self._parameters}


class BridgeWorld:
    """B environments, kept at the task's horizon."""

    def __init__(self, horizon: int, lease: Lease) -> None:
        self.batch = lease.batch
        self._horizon, self._lease = horizon, lease
        self._padding: Padding | None = None
        self._last: Moment | None = None
        self._success = np.full(self.batch, np.nan)

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world."""
        rows = self._lease.reset(seeds)
        self._last, self._success = _moment(rows), rows.success
        self._padding = Padding(self._horizon, self._last)
        return self._padding.first()

    def step(
        self, robot_action: Float[np.ndarray, "B a_r"], human_action: Float[np.ndarray, "B a_h"]
    ) -> Step:
        """Advances every world that is not over by one control step."""
        assert self._padding is not None
        assert self._last is not None
        running = self._padding.running
        if running.any():
            rows = self._lease.step(running, robot_action, human_action)
            self._last = _moment(rows)
            self._success = np.where(running, rows.success, self._success)
        return self._padding.after(self._last)

    def summary(self) -> Summary:
        """Success as the environment had it at the end; forces are unknown.

        `extra` has `steps`, those that the environment itself had.
        """
        assert self._padding is not None
        unknown = np.full(self.batch, np.nan)
        outcome = self._padding.ended_early.astype(np.int64)
        extra = {"steps": self._padding.lived.astype(np.float64)}
        return Summary(self._success.copy(), outcome, unknown, unknown.copy(), extra)

    def snapshot(self) -> Float[np.ndarray, "B 0"]:
        """Nothing to show."""
        return np.zeros((self.batch, 0))


def _moment(rows: Rows) -> Moment:
    return Moment(rows.robot, rows.human, rows.reward, rows.features, rows.ended, {})

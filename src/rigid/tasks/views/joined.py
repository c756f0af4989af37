"""Worlds of several tasks as one, for training with humans who live in different ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.protocol import Step, Summary, World


class JoinedWorlds:
    """Worlds side by side, in order; they must show and count the same things.

    Snapshots may differ in what they hold, so they have no columns.
    """

    def __init__(self, worlds: Sequence[World]) -> None:
        self._worlds = tuple(worlds)
        self.batch = sum(world.batch for world in worlds)
        self._bounds = np.cumsum([world.batch for world in worlds])[:-1]

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world."""
        parts = np.split(seeds, self._bounds)
        return _joined_steps([w.reset(s) for w, s in zip(self._worlds, parts, strict=True)])

    def step(
        self, robot_action: Float[np.ndarray, "B a_r"], human_action: Float[np.ndarray, "B a_h"]
    ) -> Step:
        """Advances every world by one control step."""
        robots, humans = (np.split(action, self._bounds) for action in (robot_action, human_action))
        return _joined_steps([
            world.step(robot, human)
            for world, robot, human in zip(self._worlds, robots, humans, strict=True)
        ])  # fmt: skip

    def summary(self) -> Summary:
        """How the episodes stand."""
        parts = [world.summary() for world in self._worlds]
        columns = (np.concatenate(rows) for rows in zip(*(p[:-1] for p in parts), strict=True))
        return Summary._make([*columns, _joined_columns([part.extra for part in parts])])

    def snapshot(self) -> Float[np.ndarray, "B state"]:
        """Nothing."""
        return np.zeros((self.batch, 0))


def _joined_steps(steps: Sequence[Step]) -> Step:
    columns = (np.concatenate(rows) for rows in zip(*(step[:-1] for step in steps), strict=True))
    info = _joined_columns([step.info for step in steps])
    return Step._make([*columns, info])


def _joined_columns(parts: Sequence[Mapping[str, np.ndarray]]) -> dict[str, np.ndarray]:
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

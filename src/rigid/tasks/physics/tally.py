"""Forces of the robot on the person, added up over an episode."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float


class ForceTally:
    """Peak, impulse and steps of unwanted contact, each of every world since its start."""

    def __init__(self, batch: int) -> None:
        self.peak = np.zeros(batch)
        """[N]"""
        self.impulse = np.zeros(batch)
        """[N s]"""
        self.unwanted_steps = np.zeros(batch, dtype=np.int64)

    def add(
        self,
        force: Float[np.ndarray, "B S"],
        unwanted: Bool[np.ndarray, " B"],
        alive: Bool[np.ndarray, " B"],
        physics_step: float,
    ) -> None:
        """Adds a control step.

        Args:
            force: On the person at each of its S physics steps [N].
            unwanted: Whether the robot touched where it should not.
            alive: Worlds that count.
            physics_step: [s]
        """
        self.unwanted_steps += unwanted & alive
        self.peak = np.maximum(self.peak, force.max(axis=1) * alive)
        self.impulse += force.sum(axis=1) * physics_step * alive

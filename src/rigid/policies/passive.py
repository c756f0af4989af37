"""A policy that does nothing: the reference beside every adversary, never an attack."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from rigid.policies.protocol import State


@dataclass
class PassivePolicy:
    """Zero actions, whatever it sees.

    Example:
        >>> PassivePolicy(observation_size=3, action_size=2).act(np.ones((1, 3)), (), None)
        (array([[0., 0.]]), ())
    """

    observation_size: int
    action_size: int

    def initial_state(self, batch: int) -> State:
        """Nothing to remember."""
        del batch
        return ()

    def act(
        self,
        observation: Float[np.ndarray, "B o"],
        state: State,
        rng: np.random.Generator | None,
    ) -> tuple[Float[np.ndarray, "B a"], State]:
        """Zeros, shape (B, `action_size`), with and without noise."""
        del rng
        return np.zeros((len(observation), self.action_size)), state

"""What every policy offers, whoever made it."""

from __future__ import annotations

from typing import Any, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

State = Any
"""Whatever a policy carries from step to step, with a leading world axis; `()` for none."""


@runtime_checkable
class Policy(Protocol):
    """Batched: B worlds at once."""

    observation_size: int
    action_size: int

    def initial_state(self, batch: int) -> State:
        """The state before the first step of an episode; `()` for a memoryless policy."""
        ...

    def act(
        self,
        observation: Float[np.ndarray, "B o"],
        state: State,
        rng: np.random.Generator | None,
    ) -> tuple[Float[np.ndarray, "B a"], State]:
        """Actions and the next state; a task takes reals beyond [-1, 1] as -1 or 1.

        Args:
            observation: What the agent sees in each world.
            state: What `initial_state` or the last call returned.
            rng: Source of the action noise; None asks for the mean action.
        """
        ...


@runtime_checkable
class Fingerprinted(Protocol):
    """A policy of another library's format, which can say what it is; optional."""

    def fingerprint(self) -> str:
        """SHA-256 over all that decides how it acts: part of 'same settings'."""
        ...

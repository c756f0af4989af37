"""The interface of a search measure: what holds an adversary close to canonical motion.

A measure turns an adversary's episodes into a penalty for each step, and may learn from them. It
steers the search and nothing else: the x axis is the referee's, whatever the measure.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol, runtime_checkable

import jax.numpy as jnp
from jaxtyping import Array, Float, Int, Key, PRNGKeyArray

from rigid.policies.gaussian import GaussianParameters


class Motion(NamedTuple):
    """The episodes of one adversary in one iteration: N episodes of T steps."""

    features: Float[Array, "T N f"]
    """Standardised by canonical motion."""
    weight: Float[Array, "T N"]
    """1, or 0 from the step on at which physics ran away."""
    observation: Float[Array, "T N o"]
    """What the policy acted on, its memory included."""
    action: Float[Array, "T N a"]
    """Actions as sampled, before clipping."""


class Health(NamedTuple):
    """How a measure fares; means over one iteration, NaN for what it does not have."""

    loss: Float[Array, ""]
    score_canonical: Float[Array, ""]
    score_adversary: Float[Array, ""]
    accuracy_canonical: Float[Array, ""]
    accuracy_adversary: Float[Array, ""]


@runtime_checkable
class Measure(Protocol):
    """A search measure: hashable settings, so that `jit` takes it as static.

    What it learns is its state, a pytree that a checkpoint can hold.
    """

    def start(
        self, key: PRNGKeyArray, canonical: Float[Array, "E T f"], human: GaussianParameters
    ) -> Any:
        """The state before any step, from standardised canonical episodes and their human."""
        ...

    def unit(self, state: Any, canonical: Float[Array, "E T f"]) -> Float[Array, ""]:
        """What penalties are divided by, frozen at the start."""
        ...

    def penalty(
        self,
        state: Any,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
    ) -> Float[Array, "T N"]:
        """What each step costs the adversary that sampled its actions from `policy`."""
        ...

    def score(self, state: Any, features: Float[Array, "T N f"]) -> Float[Array, "T N"] | None:
        """A classifier's score of each step, negative for canonical; None where there is none."""
        ...

    def update(
        self,
        state: Any,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
        iteration: Int[Array, ""],
        keys: Key[Array, "2"],
    ) -> tuple[Any, Health]:
        """The state after one iteration; one of the two `keys` trains, the other remembers."""
        ...

    def kept(self, state: Any) -> Any:
        """What is stored with the adversary, as arrays; None for nothing."""
        ...

    def score_kept(self, kept: Any, features: Float[Array, "T N f"]) -> Float[Array, "T N"] | None:
        """`score`, of what was stored."""
        ...


def unknown() -> Float[Array, ""]:
    """A health metric that a measure does not have."""
    return jnp.asarray(jnp.nan, jnp.float32)

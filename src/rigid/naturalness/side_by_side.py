"""A measure for each of several adversaries that learn in one network.

Each is told from canonical motion by a measure of its own: one that served them all would be
slower than the policy it must keep up with (docs/search.md). Ours.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, Key, PRNGKeyArray

from rigid.naturalness.measure import Health, Measure, Motion
from rigid.policies.gaussian import GaussianParameters


@dataclass(frozen=True)
class SideBySide:
    """`count` measures of one kind; states and motions of all of them are stacked in front.

    One after the other, not under `vmap`: small matrix products in a batch are slower on a
    processor (30 ms against 27 ms for a discriminator's update).
    """

    inner: Measure
    count: int

    def start(
        self, key: PRNGKeyArray, canonical: Float[Array, "E T f"], human: GaussianParameters
    ) -> Any:
        """The states before any step, each from random numbers of its own."""
        keys = jax.random.split(key, self.count)
        return _stacked([self.inner.start(each, canonical, human) for each in keys])

    def unit(self, states: Any, canonical: Float[Array, "E T f"]) -> Float[Array, " S"]:
        """What the penalties of each are divided by."""
        found: Float[Array, " S"] = jax.lax.map(
            lambda state: self.inner.unit(state, canonical), states
        )
        return found

    def penalty(
        self,
        states: Any,
        canonical: Float[Array, "E T f"],
        motions: Motion,
        policy: GaussianParameters,
    ) -> Float[Array, "S T N"]:
        """What each step costs the adversary that took it."""
        found: Float[Array, "S T N"] = jax.lax.map(
            lambda own: self.inner.penalty(own[0], canonical, own[1], policy), (states, motions)
        )
        return found

    def score(self, states: Any, features: Float[Array, "S T N f"]) -> Float[Array, "S T N"] | None:
        """Each one's classifier on its own motion; None where there is none."""
        found: Float[Array, "S T N"] | None = jax.lax.map(
            lambda own: self.inner.score(*own), (states, features)
        )
        return found

    def update(
        self,
        states: Any,
        canonical: Float[Array, "E T f"],
        motions: Motion,
        policy: GaussianParameters,
        iteration: Int[Array, ""],
        keys: Key[Array, "2"],
    ) -> tuple[Any, Health]:
        """The states after one iteration, and how each fares."""
        own_keys = jax.vmap(lambda key: jax.random.split(key, self.count), out_axes=1)(keys)

        def one(own: tuple[Any, Motion, Key[Array, "2"]]) -> tuple[Any, Health]:
            state, motion, key = own
            return self.inner.update(state, canonical, motion, policy, iteration, key)

        found: tuple[Any, Health] = jax.lax.map(one, (states, motions, own_keys))
        return found


def _stacked(states: list[Any]) -> Any:
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *states)

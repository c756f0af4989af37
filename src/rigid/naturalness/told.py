"""A measure that is told which adversary it judges, by a code behind the features.

Many adversaries that share a network (`rigid.learning.shared`) share a measure as well: canonical
motion looks the same to all of them, and each is told from it by its own code, never from another
adversary. Ours.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float, Int, Key, PRNGKeyArray

from rigid.naturalness.measure import Health, Measure, Motion
from rigid.policies.gaussian import GaussianParameters


def with_code(
    features: Float[Array, "*batch f"], code: Float[Array, "*#batch c"]
) -> Float[Array, "*batch fc"]:
    """Features with a code behind them."""
    shape = (*features.shape[:-1], code.shape[-1])
    return jnp.concatenate([features, jnp.broadcast_to(code, shape)], axis=-1)


class ToldState(NamedTuple):
    """What the shared measure learned, and whom it is asked about."""

    shared: Any
    code: Float[Array, " c"]


@dataclass(frozen=True)
class Told:
    """The measure of one adversary among those that share `inner`; its state holds the code.

    While adversaries train together `inner` itself is used, on features with codes.
    """

    inner: Measure
    size: int
    """Numbers of a code."""

    def start(
        self, key: PRNGKeyArray, canonical: Float[Array, "E T f"], human: GaussianParameters
    ) -> ToldState:
        """The inner measure's state and a code of zeros."""
        code = jnp.zeros(self.size)
        return ToldState(self.inner.start(key, with_code(canonical, code), human), code)

    def unit(self, state: ToldState, canonical: Float[Array, "E T f"]) -> Float[Array, ""]:
        """The inner measure's."""
        return self.inner.unit(state.shared, with_code(canonical, state.code))

    def penalty(
        self,
        state: ToldState,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
    ) -> Float[Array, "T N"]:
        """The inner measure's, at this code."""
        seen = motion._replace(features=with_code(motion.features, state.code))
        return self.inner.penalty(state.shared, with_code(canonical, state.code), seen, policy)

    def score(
        self, state: ToldState, features: Float[Array, "T N f"]
    ) -> Float[Array, "T N"] | None:
        """The inner measure's, at this code."""
        return self.inner.score(state.shared, with_code(features, state.code))

    def update(
        self,
        state: ToldState,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
        iteration: Int[Array, ""],
        keys: Key[Array, "2"],
    ) -> tuple[ToldState, Health]:
        """The inner measure's, at this code."""
        seen = motion._replace(features=with_code(motion.features, state.code))
        natural = with_code(canonical, state.code)
        shared, health = self.inner.update(state.shared, natural, seen, policy, iteration, keys)
        return ToldState(shared, state.code), health

    def kept(self, state: ToldState) -> ToldState:
        """What the inner measure keeps, and the code."""
        return ToldState(self.inner.kept(state.shared), state.code)

    def score_kept(
        self, kept: ToldState, features: Float[Array, "T N f"]
    ) -> Float[Array, "T N"] | None:
        """`score`, of what was stored."""
        return self.inner.score_kept(kept.shared, with_code(features, kept.code))

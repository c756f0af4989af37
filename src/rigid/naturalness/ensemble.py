"""Several measures at once, of which the most suspicious one rules at every step.

What one measure overlooks another may see (paper, appendix 'Discriminator-free Method'). Members
that only differ in their random start also disagree where none of them has seen much, which is
where a single one can be fooled.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, Key, PRNGKeyArray

from rigid.naturalness.measure import Health, Measure, Motion
from rigid.policies.gaussian import GaussianParameters


class EnsembleState(NamedTuple):
    """The members' states and units, in their order."""

    members: tuple[Any, ...]
    units: tuple[Float[Array, ""], ...]


@dataclass(frozen=True)
class Ensemble:
    """The largest of the members' penalties, each in its own frozen unit."""

    members: tuple[Measure, ...]

    def start(
        self, key: PRNGKeyArray, canonical: Float[Array, "E T f"], human: GaussianParameters
    ) -> EnsembleState:
        """Every member from a key of its own."""
        keys = jax.random.split(key, len(self.members))
        states = tuple(
            member.start(own, canonical, human)
            for member, own in zip(self.members, keys, strict=True)
        )
        units = tuple(
            member.unit(state, canonical)
            for member, state in zip(self.members, states, strict=True)
        )
        return EnsembleState(states, units)

    def unit(self, state: EnsembleState, canonical: Float[Array, "E T f"]) -> Float[Array, ""]:
        """1: the members' penalties have theirs already."""
        del state, canonical
        return jnp.ones(())

    def penalty(
        self,
        state: EnsembleState,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
    ) -> Float[Array, "T N"]:
        """The largest one."""
        return jnp.stack([
            member.penalty(own, canonical, motion, policy) / unit
            for (member, own), unit in zip(self._pairs(state), state.units, strict=True)
        ]).max(axis=0)  # fmt: skip

    def score(
        self, state: EnsembleState, features: Float[Array, "T N f"]
    ) -> Float[Array, "T N"] | None:
        """The largest score of the members that have one: canonical where all say so."""
        return self.score_kept(self.kept(state), features)

    def update(
        self,
        state: EnsembleState,
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
        iteration: Int[Array, ""],
        keys: Key[Array, "2"],
    ) -> tuple[EnsembleState, Health]:
        """Every member learns by itself; metrics are means over the members that have them."""
        updated = [
            member.update(
                own, canonical, motion, policy, iteration,
                jax.vmap(jax.random.fold_in, (0, None))(keys, index),
            )
            for index, (member, own) in enumerate(self._pairs(state))
        ]  # fmt: skip
        health = jax.tree.map(lambda *each: jnp.nanmean(jnp.stack(each)), *(h for _, h in updated))
        return state._replace(members=tuple(after for after, _ in updated)), health

    def kept(self, state: EnsembleState) -> list[Any]:
        """What the members keep."""
        return [member.kept(own) for member, own in self._pairs(state)]

    def score_kept(
        self, kept: list[Any], features: Float[Array, "T N f"]
    ) -> Float[Array, "T N"] | None:
        """The largest score of the members that have one."""
        pairs = zip(self.members, kept, strict=True)
        scores = [member.score_kept(own, features) for member, own in pairs]
        known = [each for each in scores if each is not None]
        return jnp.stack(known).max(axis=0) if known else None

    def _pairs(self, state: EnsembleState) -> Iterator[tuple[Measure, Any]]:
        return zip(self.members, state.members, strict=True)

"""Maximum mean discrepancy: how far an adversary is from canonical motion, without a classifier.

MMD² = E k(y, y') + E k(x, x') - 2 E k(x, y), x canonical and y adversarial (Gretton et al., 2012;
paper, appendix 'Discriminator-free Method'). k is the mean of Gaussian kernels

    exp(-|x - y|² / 2h²),   h = b · (1/4, 1/2, 1, 2, 4),

b the median distance of canonical rows. A policy that follows the slope of MMD² is paid, per step,
by its derivative at the step's features, the witness

    w(x) = E k(x, y) - E k(x, x').

Both are unbiased: a row is never held against itself nor, since neighbouring steps are alike,
against its own episode. The paper gives no bandwidths; ours span a factor of 16, so that the widest
still pulls from far away and the narrowest still sees small differences.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float, Int, Key, PRNGKeyArray

from rigid.naturalness.measure import Health, Motion, unknown
from rigid.policies.gaussian import GaussianParameters

OCTAVES = 2
"""Bandwidths from the median distance / 2² to the median distance · 2², in factors of 2. Ours."""
REFERENCES = 1024
"""Rows of each side that kernels are held against, spread evenly: the sampling error of the witness
is small beside its range, and all rows would cost more than the physics. Ours."""
_MEDIAN_ROWS = 512


class Rows(NamedTuple):
    """Rows of features with a weight each, and the episode that each comes from."""

    values: Float[Array, "n f"]
    weight: Float[Array, " n"]
    episode: Int[Array, " n"]


@dataclass(frozen=True)
class MMD:
    """The witness as penalty; its state is the median distance.

    Its unit is the deviation, on canonical motion, of the witness before there is any adversary:
    how much the density of canonical motion varies over canonical motion.
    """

    references: int = REFERENCES

    def start(
        self, key: PRNGKeyArray, canonical: Float[Array, "E T f"], human: GaussianParameters
    ) -> Float[Array, ""]:
        """Median distance between canonical rows."""
        del key, human
        return median_distance(_some(of_episodes(canonical), _MEDIAN_ROWS).values)

    def unit(self, state: Float[Array, ""], canonical: Float[Array, "E T f"]) -> Float[Array, ""]:
        """Deviation of the mean kernel of canonical rows with each other."""
        rows = _some(of_episodes(canonical), self.references)
        return jnp.maximum(mean_kernel(rows, rows, state, same=True).std(), 1e-3)

    def penalty(
        self,
        state: Float[Array, ""],
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
    ) -> Float[Array, "T N"]:
        """The witness at every step."""
        del policy
        mine, natural = self._of_motion(motion), of_episodes(canonical)
        others, canonical_ = _some(mine, self.references), _some(natural, self.references)
        found = mean_kernel(mine, others, state, same=True) - mean_kernel(
            mine, canonical_, state, same=False
        )
        return found.reshape(motion.weight.T.shape).T

    def score(self, state: Float[Array, ""], features: Float[Array, "T N f"]) -> None:
        """There is no classifier."""
        del state, features

    def update(
        self,
        state: Float[Array, ""],
        canonical: Float[Array, "E T f"],
        motion: Motion,
        policy: GaussianParameters,
        iteration: Int[Array, ""],
        keys: Key[Array, "2"],
    ) -> tuple[Float[Array, ""], Health]:
        """Nothing to learn; the loss is MMD²."""
        del policy, iteration, keys
        mine, natural = (
            _some(rows, self.references)
            for rows in (self._of_motion(motion), of_episodes(canonical))
        )
        found = mmd2(mine, natural, state)
        return state, Health(found, unknown(), unknown(), unknown(), unknown())

    def kept(self, state: Float[Array, ""]) -> dict[str, Array]:
        """The bandwidths."""
        return {"bandwidths": bandwidths(state)}

    def score_kept(self, kept: dict[str, Array], features: Float[Array, "T N f"]) -> None:
        """There is no classifier."""
        del kept, features

    def _of_motion(self, motion: Motion) -> Rows:
        rows = of_episodes(motion.features.swapaxes(0, 1))
        weight = motion.weight.T.reshape(-1)
        # What follows a fault weighs nothing, and must not spoil a sum by being huge.
        return rows._replace(values=jnp.where(weight[:, None] > 0, rows.values, 0.0), weight=weight)


def bandwidths(median: Float[Array, ""]) -> Float[Array, " k"]:
    """Widths h of the kernels, widest first."""
    return jnp.stack([median * 2.0**octave for octave in range(OCTAVES, -OCTAVES - 1, -1)])


def median_distance(rows: Float[Array, "n f"]) -> Float[Array, ""]:
    """Median distance between two different rows."""
    upper = jnp.triu_indices(rows.shape[0], 1)
    return jnp.maximum(jnp.sqrt(jnp.median(_squared(rows, rows)[upper])), 1e-3)


def mean_kernel(
    rows: Rows, others: Rows, median: Float[Array, ""], *, same: bool
) -> Float[Array, " n"]:
    """Mean kernel of each of `rows` with `others`.

    Args:
        rows: Where it is wanted.
        others: Against what; their weights count.
        median: Median distance of canonical rows.
        same: Whether both come from the same episodes: then a row's own episode does not count.
    """
    # h falls by 2, so that each kernel is the fourth power of the one before.
    widest = jnp.exp(-_squared(rows.values, others.values) / (2 * (median * 2.0**OCTAVES) ** 2))
    kernels = [widest]
    for _ in range(2 * OCTAVES):
        kernels.append(kernels[-1] ** 4)
    counted = jnp.broadcast_to(others.weight, widest.shape)
    if same:
        counted = jnp.where(rows.episode[:, None] == others.episode[None, :], 0.0, counted)
    total = (sum(kernels) * counted).sum(axis=1) / len(kernels)
    return total / jnp.maximum(counted.sum(axis=1), 1.0)


def mmd2(adversary: Rows, canonical: Rows, median: Float[Array, ""]) -> Float[Array, ""]:
    """Unbiased MMD² (it may be negative), from rows grouped in episodes."""
    within = [
        _mean(mean_kernel(rows, rows, median, same=True), rows.weight)
        for rows in (adversary, canonical)
    ]
    between = _mean(mean_kernel(adversary, canonical, median, same=False), adversary.weight)
    return within[0] + within[1] - 2 * between


def of_episodes(features: Float[Array, "E T f"]) -> Rows:
    """Every step of sound episodes."""
    episodes, steps = features.shape[:2]
    own = jnp.repeat(jnp.arange(episodes), steps)
    return Rows(features.reshape(episodes * steps, -1), jnp.ones(episodes * steps), own)


def _some(rows: Rows, count: int) -> Rows:
    """At most `count` rows, spread evenly over episodes and steps."""
    total = rows.values.shape[0]
    if total <= count:
        return rows
    picked = (jnp.arange(count) * total) // count
    return Rows(*(column[picked] for column in rows))


def _squared(rows: Float[Array, "n f"], others: Float[Array, "m f"]) -> Float[Array, "n m"]:
    """Squared distances."""
    size, other_size = (rows**2).sum(axis=1), (others**2).sum(axis=1)
    return jnp.maximum(size[:, None] + other_size[None, :] - 2 * rows @ others.T, 0.0)


def _mean(x: Float[Array, " n"], weight: Float[Array, " n"]) -> Float[Array, ""]:
    return (x * weight).sum() / jnp.maximum(weight.sum(), 1.0)

"""One network for many λ: a policy that is told its λ, and the policy that it is at one λ.

The first layer sees, behind the observation, a code of λ: the way from the first of the weights
that were asked for to the last is marked by `CODE_SIZE` knots, and each number of the code peaks at
its knot and falls to 0 at the neighbours. A fixed code only adds to the first layer's bias, so that
the policy at one λ is an ordinary network. Ours; the paper trains a network for each λ.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from rigid.policies.gaussian import GaussianParameters
from rigid.policies.networks import Normaliser

CODE_SIZE = 8
"""Knots; a λ between two of them is a mix of both. Ours."""
CODE_PEAK = 2.5
"""Largest number of a code. Ours: at 1 all λ of a network do nearly the same, since the dozens of
observations beside it drown a code; at 5 known optima are met within 30 % instead of 4."""


@dataclass(frozen=True, kw_only=True)
class Sharing:
    """Two networks for all λ: a wild one, of random weights, and a natural one, the human. Ours."""

    natural_start: float = 0.2
    """λ from which on an adversary belongs to the natural one: between where the two begin and end,
    so that neither serves a λ at the edge of what it trains at."""
    wild_slots: int = 4
    natural_slots: int = 8
    """λ that each of them plays at a time."""
    wild_to: float = 0.4
    """The wild one also trains at λ up to here: some pull towards canonical motion leads it out of
    sabotage that is not the worst."""
    wild_noise: float = 3.0
    """The wild one starts with this many times the human's action noise: with the human's alone
    half of the seeds stay where the arm only keeps out of the robot's reach."""
    wild_quiet_from: float = 0.6
    """Share of the iterations after which it has the human's noise."""
    natural_from: float = 0.1
    """The natural one also trains at λ from here on: those that are pulled less find the robot's
    weak places first, for the others to make natural."""
    natural_average: float = 0.4
    """The natural one is, in the end, the moving average of its networks over this share of the
    iterations. Its last one alone still wanders around where a discriminator holds it, which a
    referee that learned from all of its motion tells from canonical. 0: its last one."""
    retreat: float = 0.3
    """Its adversaries of `retreat_from` and more then go this share of the way back to the human,
    weight by weight (as Wortsman et al. 2022, 'Robust fine-tuning of zero-shot models'): most of
    what it does to the robot stays, and what a referee tells it by goes."""
    retreat_from: float = 1.0
    """λ from which on being canonical counts for more than harm."""

    def __post_init__(self) -> None:
        """Raises `ValueError` for families that could not reach both ends or come to rest."""
        if min(self.wild_slots, self.natural_slots) < 2:
            raise ValueError(
                "a family needs 2 slots or more to reach both ends of its range, got wild_slots "
                f"{self.wild_slots} and natural_slots {self.natural_slots}"
            )

        if self.wild_noise <= 0 or not 0 < self.wild_quiet_from <= 1:
            raise ValueError(
                "the wild family needs noise above 0 and a share of iterations in (0, 1], got "
                f"wild_noise {self.wild_noise} and wild_quiet_from {self.wild_quiet_from}"
            )

        if not 0 <= self.natural_average <= 1:
            raise ValueError(
                "the natural family is averaged over a share of the iterations in [0, 1], got "
                f"natural_average {self.natural_average}"
            )

        if not 0 <= self.retreat < 1:
            raise ValueError(
                "adversaries go back a share of the way to the human in [0, 1), got "
                f"retreat {self.retreat}"
            )

        if not self.retreat_from >= 0:
            raise ValueError(
                "adversaries go back from a λ of 0 or more on, got retreat_from "
                f"{self.retreat_from}"
            )

    @property
    def slots(self) -> int:
        """λ that both play at a time."""
        return self.wild_slots + self.natural_slots


def codes_at(places: Float[np.ndarray, " n"], count: int) -> Float[np.ndarray, "n c"]:
    """Codes of places among `count` weights: 0 is the first, `count` - 1 the last.

    Example:
        >>> (codes_at(np.array([0.0, 0.25, 2.0]), 3)[:, [0, 1, -1]] / CODE_PEAK).tolist()
        [[1.0, 0.0, 0.0], [0.125, 0.875, 0.0], [0.0, 0.0, 1.0]]
    """
    along = places / max(count - 1, 1) * (CODE_SIZE - 1)
    away = np.abs(along[:, np.newaxis] - np.arange(CODE_SIZE))
    return np.asarray(CODE_PEAK * np.maximum(1 - away, 0.0), dtype=np.float32)


def lambda_at(lambdas: Sequence[float], place: float) -> float:
    """The λ at a place among ascending ones; between two it is their weighted geometric mean.

    Next to 0 or ∞, which have no logarithm, it is the nearer of the two.

    Example:
        >>> [round(lambda_at([0.01, 1.0, math.inf], place), 3) for place in (0.5, 1.4, 1.6)]
        [0.1, 1.0, inf]
    """
    below, above = lambdas[math.floor(place)], lambdas[math.ceil(place)]
    if below <= 0 or math.isinf(above):
        return lambdas[round(place)]
    share = place - math.floor(place)
    return float(below ** (1 - share) * above**share)


def draw_places(count: int, slots: int, rng: np.random.Generator) -> Float[np.ndarray, " slots"]:
    """A place for each slot: near its own of `slots` even places, of which two are the ends.

    A draw beyond an end is the end, so that the outermost weights are played as often as others.
    """
    pace = (count - 1) / (slots - 1)
    drawn = pace * (np.arange(slots) + rng.uniform(-0.5, 0.5, slots))
    return np.asarray(np.clip(drawn, 0, count - 1))


def slot_of(index: int, count: int, slots: int) -> int:
    """The slot that plays nearest to weight number `index` of `count`.

    Example:
        >>> [slot_of(index, 5, 3) for index in range(5)]
        [0, 0, 1, 2, 2]
    """
    return round(index * (slots - 1) / max(count - 1, 1))


def told(parameters: GaussianParameters) -> GaussianParameters:
    """The policy with room for a code, which it does not heed yet."""
    first, *others = parameters.network
    blind = jnp.zeros((CODE_SIZE, first["w"].shape[1]))
    network = [{**first, "w": jnp.concatenate([first["w"], blind])}, *others]
    mean, variance, rows = parameters.normaliser
    normaliser = Normaliser(
        jnp.concatenate([mean, jnp.zeros(CODE_SIZE)]),
        jnp.concatenate([variance, jnp.ones(CODE_SIZE)]),
        rows,
    )
    return parameters._replace(network=network, normaliser=normaliser)


def at_code(parameters: GaussianParameters, code: Float[Array, " c"]) -> GaussianParameters:
    """The policy without a code that does what a told one does at `code`."""
    first, *others = parameters.network
    size = first["w"].shape[0] - CODE_SIZE
    mean, variance, rows = parameters.normaliser
    return parameters._replace(
        network=[{"w": first["w"][:size], "b": first["b"] + code @ first["w"][size:]}, *others],
        normaliser=Normaliser(mean[:size], variance[:size], rows),
    )

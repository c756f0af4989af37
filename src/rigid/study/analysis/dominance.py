"""Who lies above the frontier: people, and their single episodes, against what the search found.

Section 5.2 says of people that 'points on the RIGID curve Pareto-dominate' them. A point dominates
a person when it is at least as natural and at least as adversarial (x' ≥ x, y' ≥ y). That k of n
people are not dominated is an estimate, and k = 0 does not show that nobody would be: `Share` says
how many there may be.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from rigid.frontier.curve import hull_at
from rigid.frontier.intervals import t_interval


class Frontage(NamedTuple):
    """What people are held against: the adversaries that count, and canonical play at x = 1."""

    naturalness: Float[np.ndarray, " m"]
    adversarialness: Float[np.ndarray, " m"]
    """Mean over episodes: the points of the frontier's plot."""
    of_episodes: Float[np.ndarray, " m"]
    """A high quantile of the adversarialness of each one's *episodes*. Single episodes are held
    against these: an episode scatters more than a mean, so that of a harmless person too some lie
    above every mean."""


class Share(NamedTuple):
    """k of n, with the largest share that this leaves possible."""

    above: int
    of: int
    at_most: float | None
    """Upper Clopper-Pearson bound; None for n = 0."""


def height_at(
    naturalness: Float[np.ndarray, " m"], heights: Float[np.ndarray, " m"], x: float
) -> float:
    """The highest of the points that are at least as natural as `x`; 0 where there is none.

    Args:
        naturalness: Of the points.
        heights: Their adversarialness, or a quantile of their episodes.
        x: Naturalness of a person.

    Example:
        >>> height_at(np.array([0.2, 0.9, 1.0]), np.array([0.9, 0.4, 0.1]), 0.5)
        0.4
    """
    return float(heights[naturalness >= x].max(initial=0.0))


def hull_height(front: Frontage, x: float) -> float:
    """Height of the concave hull of all points at `x`, which mixing humans by episode attains.

    The last point of `front` that stands at naturalness 1 is canonical play, so that the hull
    reaches there.
    """
    points = np.stack([front.naturalness, front.adversarialness], axis=1)
    return float(hull_at(points, [x])[0])


def clearly_above(height: float, harm: Float[np.ndarray, " e"], confidence: float = 0.95) -> bool:
    """Whether a person's mean lies above a height by more than its episodes scatter.

    One-sided, by Student's t over episodes; never with a single one.
    """
    interval = t_interval(harm, 2 * confidence - 1) if len(harm) else None
    return interval is not None and interval.low > height


def dominated(front: Frontage, x: float, y: float) -> bool:
    """Whether a point is at least as natural and at least as adversarial as somebody at (x, y)."""
    return y <= height_at(front.naturalness, front.adversarialness, x)


def episodes_above(front: Frontage, x: float, harm: Float[np.ndarray, " e"]) -> int:
    """How many episodes of a person lie above the episodes of every adversary as natural as it.

    An episode is above when its adversarialness exceeds, for each adversary with x' ≥ x and for
    canonical play, the high quantile of its episodes.

    Args:
        front: What the search found.
        x: Naturalness of the person: a single episode has none of its own.
        harm: Adversarialness of each of the person's episodes.
    """
    return int((harm > height_at(front.naturalness, front.of_episodes, x)).sum())


def share(above: Sequence[bool], confidence: float = 0.95) -> Share:
    """How many of n people, with the upper Clopper-Pearson bound (Biometrika 26, 1934), one-sided.

    Args:
        above: For each person whether it holds. People are the unit: the episodes of one person are
            no independent draws.
        confidence: Of the bound.

    Example:
        >>> found = share([False] * 8)
        >>> found.above, found.of, round(found.at_most, 2)
        (0, 8, 0.31)
    """
    from scipy.stats import binomtest  # Here, since its import takes long.

    count, of = sum(above), len(above)
    if not of:
        return Share(0, 0, None)
    bound = binomtest(count, of, alternative="less").proportion_ci(confidence, method="exact").high
    return Share(count, of, float(bound))

"""95 % intervals over episodes: of means, of ratios, of shares, and of paired differences."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.special import betaincinv, ndtri

from rigid.frontier.intervals import t_interval

_CONFIDENCE = 0.95
_UNBOUNDED = (-np.inf, np.inf)


class Estimate(NamedTuple):
    """A value and its 95 % interval."""

    value: float
    low: float
    high: float


def mean(values: Float[np.ndarray, " n"]) -> Estimate:
    """The mean with Student's t interval, n >= 2."""
    ends = t_interval(values, _CONFIDENCE, _UNBOUNDED)
    if ends is None:
        raise ValueError("one value has no interval")
    return Estimate(float(np.mean(values)), ends.low, ends.high)


def relative(mine: Float[np.ndarray, " n"], reference: Float[np.ndarray, " n"]) -> Estimate:
    """By which share the sum of `mine` exceeds that of `reference`, paired by episode.

    Ratio R of the means; its interval is Student's t of the residuals x - R y over the mean of y
    (Cochran, Sampling Techniques, 1977, section 6.4).

    Example:
        >>> found = relative(np.array([1.2, 2.0]), np.array([1.0, 2.0]))
        >>> round(found.value, 4), found.low < 0 < found.high
        (0.0667, True)
    """
    ratio = float(mine.sum() / reference.sum())
    residuals = mean((mine - ratio * reference) / reference.mean())
    return Estimate(ratio - 1, ratio - 1 + residuals.low, ratio - 1 + residuals.high)


def share(hits: Float[np.ndarray, " n"]) -> Estimate:
    """A share of yes with the exact interval of Clopper and Pearson (1934).

    Example:
        >>> [round(one, 4) for one in share(np.zeros(100))]
        [0.0, 0.0, 0.0362]
    """
    count, total, tail = float(hits.sum()), len(hits), (1 - _CONFIDENCE) / 2
    low = float(betaincinv(count, total - count + 1, tail)) if count else 0.0
    high = float(betaincinv(count + 1, total - count, 1 - tail)) if count < total else 1.0
    return Estimate(count / total, low, high)


def share_difference(mine: Float[np.ndarray, " n"], reference: Float[np.ndarray, " n"]) -> Estimate:
    """Difference of two shares of yes, paired by episode.

    The interval of Agresti and Min (2005): half an observation more in each of the four cells, so
    that equal episodes leave it some width.

    Example:
        >>> [round(one, 4) + 0.0 for one in share_difference(np.ones(400), np.ones(400))]
        [0.0, -0.0049, 0.0049]
    """
    gained = float(((mine > 0) & (reference == 0)).sum()) + 0.5
    lost = float(((mine == 0) & (reference > 0)).sum()) + 0.5
    total = len(mine) + 2
    centre = (gained - lost) / total
    error = np.sqrt(gained + lost - (gained - lost) ** 2 / total) / total
    reach = float(ndtri((1 + _CONFIDENCE) / 2) * error)
    return Estimate(float(np.mean(mine - reference)), centre - reach, centre + reach)

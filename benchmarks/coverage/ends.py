"""Ends of 95 % intervals of a mean, for many draws at once: the printed one and its rivals.

Every function here takes values [n, draws] within `bounds` and returns the ends [2, draws].
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit
from scipy.stats import ksone

from rigid.frontier.intervals import bca_interval, both_scales_ends, t_ends

CONFIDENCE = 0.95

Bounds = tuple[float, float]
Ends = Callable[[Float[np.ndarray, "n d"], Bounds], Float[np.ndarray, "2 d"]]


def printed(values: Float[np.ndarray, "n d"], bounds: Bounds) -> Float[np.ndarray, "2 d"]:
    """The t interval as RIGID prints it, clipped to the bounds."""
    return t_ends(values, CONFIDENCE, bounds)


def both_scales(values: Float[np.ndarray, "n d"], bounds: Bounds) -> Float[np.ndarray, "2 d"]:
    """The wider end, on either side, of t intervals of the mean and of its logit.

    Its upper end is the bound that `rigid gate` holds against a limit.
    """
    return both_scales_ends(values, CONFIDENCE, bounds)


def guaranteed(values: Float[np.ndarray, "n d"], bounds: Bounds) -> Float[np.ndarray, "2 d"]:
    """Anderson's interval (1969): covers at least 95 % whatever the law within the bounds.

    The distribution function lies nowhere farther than ε above or below the sample's, with 97.5 %
    each (Kolmogorov and Smirnov); each end is the mean of the law that this leaves as the worst:
    a mass ε of the sample's one end is moved to the opposite bound.

    Example:
        >>> guaranteed(np.full((8, 1), 0.05), (0.0, 1.0)).round(2).ravel().tolist()
        [0.03, 0.48]
    """
    n = len(values)
    moved = float(ksone.ppf((1 + CONFIDENCE) / 2, n))
    kept = np.clip(np.arange(1, n + 1) / n - moved, 0.0, 1 / n)[:, np.newaxis]
    ascending = np.sort(values, axis=0)
    ends: Float[np.ndarray, "2 d"] = np.stack([
        bounds[0] * moved + (kept[::-1] * ascending).sum(axis=0),
        bounds[1] * moved + (kept * ascending).sum(axis=0),
    ])  # fmt: skip
    return ends


def unpaired_too(
    first: Float[np.ndarray, "n d"], second: Float[np.ndarray, "n d"], bounds: Bounds
) -> Float[np.ndarray, "2 d"]:
    """The t interval of a paired difference, without credit for what pairing takes off its spread.

    The standard error is the larger of the paired one and √(s₁²/n + s₂²/n).

    Example:
        >>> first, second = np.array([[0.4], [0.5], [0.6]]), np.array([[0.3], [0.4], [0.5]])
        >>> unpaired_too(first, second, (-1.0, 1.0)).round(3).ravel().tolist()
        [-0.251, 0.451]
    """
    n = len(first)
    difference = first - second
    variance = np.maximum(
        difference.var(axis=0, ddof=1), first.var(axis=0, ddof=1) + second.var(axis=0, ddof=1)
    )
    reach = float(stdtrit(n - 1, (1 + CONFIDENCE) / 2)) * np.sqrt(variance / n)
    mean = difference.mean(axis=0)
    ends: Float[np.ndarray, "2 d"] = np.clip([mean - reach, mean + reach], *bounds)
    return ends


def bca(values: Float[np.ndarray, "n d"], bounds: Bounds) -> Float[np.ndarray, "2 d"]:
    """The BCa interval as RIGID prints it beside the other, from 30 values on."""
    del bounds
    rng = np.random.default_rng(0)
    found = [bca_interval(column, rng, CONFIDENCE) for column in values.T]
    ends: Float[np.ndarray, "2 d"] = np.array(found, dtype=float).T
    return ends


INTERVALS: dict[str, Ends] = {
    "t, as printed": printed, "t, both scales": both_scales, "guaranteed": guaranteed,
}  # fmt: skip
"""Tried at every size; BCa only where it is printed."""

"""Intervals of a mean over search seeds, and of the difference of two robots on the same seeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from jaxtyping import Float, Real
from scipy.special import expit, logit, stdtrit

BCA_MIN_SEEDS = 30
"""Fewer seeds make BCa too narrow: its "95 %" interval covers 90 % at n = 10."""

_ROUNDING = 1e-9
"""By how much an area may leave [0, 1] in its last digits."""

_Values = Real[np.ndarray, " n"] | Sequence[float | int]
_Seed = TypeVar("_Seed", int, str)


class Interval(NamedTuple):
    """A confidence interval, low <= high, in the unit of what it brackets."""

    low: float
    high: float


class PairedDifference(NamedTuple):
    """Mean of a - b over the seeds that both have, and its interval (None for one seed)."""

    mean: float
    interval: Interval | None
    seeds: tuple[int | str, ...]


def t_interval(
    values: _Values, confidence: float = 0.95, bounds: tuple[float, float] = (0.0, 1.0)
) -> Interval | None:
    """Returns Student's t interval of the mean, clipped to `bounds`; None for one value.

    Ours: with 3 seeds a percentile bootstrap "95 %" interval covers 73 %, the t interval 95 %.

    Raises:
        ValueError: `values` are empty, not one row or not finite; or `confidence` is not in (0, 1).

    Example:
        >>> low, high = t_interval([0.4, 0.5, 0.6])
        >>> round(low, 3), round(high, 3)
        (0.252, 0.748)
    """
    row = _checked_values(values)
    check_confidence(confidence)
    if len(row) == 1:
        return None
    low, high = t_ends(row, confidence, bounds).tolist()
    return Interval(low, high)


def upper_bound(values: _Values, confidence: float = 0.95) -> float | None:
    """Returns the upper end of `both_scales_ends` for shares in [0, 1]; None for one value.

    Never below the upper end of the t interval. That one promises too much where values are skewed
    towards 0: of 10 draws from Beta(0.5, 9.5) the mean lies above it in 12 % of cases, above this
    bound in 6 % (2.5 % is nominal; `benchmarks.coverage`). For decisions that must not err
    downwards; neither bound knows of what no seed found.

    Args:
        values: One value per seed, in [0, 1]. Shape (n,).
        confidence: Nominal cover of the two-sided interval whose upper end this is, in (0, 1).

    Raises:
        ValueError: As `t_interval`, or a value leaves [0, 1].

    Example:
        >>> values = [0.01, 0.02, 0.06]
        >>> round(t_interval(values).high, 3), round(upper_bound(values), 3)
        (0.096, 0.228)
    """
    row = _checked_values(values)
    check_confidence(confidence)
    if row.min() < -_ROUNDING or row.max() > 1.0 + _ROUNDING:
        raise ValueError(f"values must lie in [0, 1], got {row.tolist()}")
    if len(row) == 1:
        return None
    return float(both_scales_ends(row, confidence, (0.0, 1.0))[1])


def bca_interval(
    values: _Values, rng: np.random.Generator, confidence: float = 0.95
) -> Interval | None:
    """Returns the BCa bootstrap interval of the mean; None below `BCA_MIN_SEEDS` values.

    Args:
        values: One value per seed. Shape (n,).
        rng: Source of the resamples; the same generator state gives the same interval.
        confidence: Nominal cover, in (0, 1).

    Raises:
        ValueError: As `t_interval`.
    """
    row = _checked_values(values)
    check_confidence(confidence)
    if len(row) < BCA_MIN_SEEDS:
        return None
    if np.ptp(row) < 1e-12:  # BCa is undefined when all resamples agree.
        return Interval(float(row.mean()), float(row.mean()))
    # Here, since this import takes longer than all the rest and most runs have fewer seeds.
    from scipy.stats import bootstrap

    ends = bootstrap((row,), np.mean, confidence_level=confidence, method="BCa", rng=rng)
    return Interval(float(ends.confidence_interval.low), float(ends.confidence_interval.high))


def paired_difference(
    a_by_seed: Mapping[_Seed, float], b_by_seed: Mapping[_Seed, float], confidence: float = 0.95
) -> PairedDifference:
    """Compares two robots on the search seeds they share: mean of a - b with its t interval.

    Ours: what a seed finds is alike for both robots, so differences vary less than values. The
    interval is clipped to [-1, 1], the range of a difference of two shares.

    Raises:
        ValueError: No seed is common to both, or a value is not finite.

    Example:
        >>> mean, interval, seeds = paired_difference({0: 0.5, 1: 0.7}, {1: 0.6, 2: 0.9})
        >>> round(mean, 3), interval, seeds
        (0.1, None, (1,))
    """
    seeds = tuple(seed for seed in a_by_seed if seed in b_by_seed)
    if not seeds:
        raise ValueError(f"no common seed: a has {list(a_by_seed)}, b has {list(b_by_seed)}")
    differences = np.array([a_by_seed[seed] - b_by_seed[seed] for seed in seeds])
    interval = t_interval(differences, confidence, bounds=(-1.0, 1.0))
    return PairedDifference(float(differences.mean()), interval, seeds)


def _checked_values(values: object) -> Float[np.ndarray, " n"]:
    row = np.asarray(values, dtype=float)
    if row.ndim != 1 or not len(row):
        raise ValueError(f"values must be one row with at least one value, got shape {row.shape}")
    if not np.isfinite(row).all():
        raise ValueError(f"values must be finite, got {row.tolist()}")
    return row


def check_confidence(confidence: float) -> None:
    """Raises `ValueError` unless `confidence` lies in (0, 1)."""
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must lie in (0, 1), got {confidence}")


def t_ends(
    values: Float[np.ndarray, "n ..."], confidence: float, bounds: tuple[float, float]
) -> Float[np.ndarray, "2 ..."]:
    """Returns both ends of the t interval of the mean over the first axis, n >= 2."""
    n = len(values)
    quantile = stdtrit(n - 1, (1.0 + confidence) / 2.0)
    mean = values.mean(axis=0)
    reach = quantile * values.std(axis=0, ddof=1) / np.sqrt(n)
    ends: Float[np.ndarray, "2 ..."] = np.clip([mean - reach, mean + reach], *bounds)
    return ends


def both_scales_ends(
    values: Float[np.ndarray, "n ..."], confidence: float, bounds: tuple[float, float]
) -> Float[np.ndarray, "2 ..."]:
    """Returns the outer ends of two t intervals of the mean: on its own scale, and on the logit's.

    With p the mean m as a share of the way from the lower to the upper bound, and s its standard
    error on the same scale, the second interval is logit p ± t·s / (p (1 - p)), taken back: s is
    carried over by the slope of the logit (delta method). Near a bound its far end lies farther out
    than the first one's, which is where a skewed law hides what a small sample has not seen. It
    still brackets the mean, not a typical value. Ours: the wider of both at each end.

    Args:
        values: Values within the bounds; the mean is over the first axis, n >= 2.
        confidence: Nominal cover of each of the two intervals, in (0, 1).
        bounds: Least and largest possible value, both finite.

    Example:
        >>> both_scales_ends(np.array([0.01, 0.02, 0.06]), 0.95, (0.0, 1.0)).round(3).tolist()
        [0.0, 0.228]
    """
    low, high = t_ends(values, confidence, (-np.inf, np.inf))
    start, width = bounds[0], bounds[1] - bounds[0]
    # Values all at one bound have no spread; any centre off the bound gives them no width.
    share = np.clip(((low + high) / 2 - start) / width, 1e-12, 1 - 1e-12)
    reach = (high - low) / (2 * width) / (share * (1 - share))
    stretched = start + width * expit(logit(share) + np.multiply.outer([-1.0, 1.0], reach))
    plain = np.clip([low, high], *bounds)
    # Without spread both agree but for rounding, which must not carry an end past a limit.
    outer = np.where(reach > 0.0, stretched, plain)
    ends: Float[np.ndarray, "2 ..."] = np.stack([
        np.minimum(plain[0], outer[0]), np.maximum(plain[1], outer[1]),
    ])  # fmt: skip
    return ends

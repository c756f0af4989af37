"""How far raters agree: Krippendorff's alpha, with an interval over pairs drawn anew."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from rigid.frontier.intervals import Interval, t_interval

Scale = Literal["nominal", "ordinal"]
FEWEST_PAIRS = 5
"""For an interval. Ours."""


class Agreement(NamedTuple):
    """1: all agree; 0: as if by chance; below: less than that."""

    alpha: float | None
    """None where it is undefined: fewer than two raters of one thing, or always one answer."""
    interval: Interval | None
    """Over pairs drawn anew; None for fewer than five pairs."""
    raters: int
    pairs: int


def agreement(
    values: Float[np.ndarray, " n"],
    raters: Int[np.ndarray, " n"],
    units: Int[np.ndarray, " n"],
    pairs: Int[np.ndarray, " n"],
    *,
    scale: Scale,
    confidence: float = 0.95,
) -> Agreement:
    """Krippendorff's alpha of answers (Content Analysis, chapter 12), with an interval over pairs.

    Student's t on the jackknife: each pair is left out once, both its members together. With 15
    raters and 30 pairs a "95 %" interval covers 95 % where raters agree (α = 0.36) and 88 % where
    they do not at all, the bootstrap over pairs 93 % and 85 %; with 12 pairs 94 % and 83 %, the
    bootstrap 91 % and 80 %. The raters are those who took part: few of them cannot be drawn anew.

    Args:
        values: Answers. Shape (n,).
        raters: Who gave each. Shape (n,).
        units: What each is about: a pair, or one member of a pair. Shape (n,).
        pairs: The pair that it belongs to. Shape (n,).
        scale: `ordinal` weighs disagreements by how many answers lie between.
        confidence: Nominal cover.
    """
    people, pair_names = len(np.unique(raters)), np.unique(pairs)
    names, unit = np.unique(units, return_inverse=True)
    levels, level = np.unique(values, return_inverse=True)
    counts = np.zeros((len(names), len(levels)), dtype=int)
    np.add.at(counts, (unit, level), 1)
    alpha, count = _alpha(counts, levels, scale), len(pair_names)
    if alpha is None or count < FEWEST_PAIRS:
        return Agreement(alpha, None, people, count)
    of_pair = np.zeros(len(names), dtype=pairs.dtype)
    of_pair[unit] = pairs
    without = [_alpha(counts[of_pair != pair], levels, scale) for pair in pair_names]
    if any(value is None for value in without):  # One pair alone had a second answer.
        return Agreement(alpha, None, people, count)
    values_of_pairs = count * alpha - (count - 1) * np.array(without, dtype=float)
    interval = t_interval(values_of_pairs, confidence, bounds=(-1.0, 1.0))
    return Agreement(alpha, interval, people, count)


def _alpha(
    counts: Int[np.ndarray, "u v"], levels: Float[np.ndarray, " v"], scale: Scale
) -> float | None:
    """Alpha from how often each thing got each answer; None where it is undefined."""
    import krippendorff

    pairable = counts[counts.sum(axis=1) >= 2]
    given = pairable.sum(axis=0) > 0
    if given.sum() < 2:  # Without two answers there is nothing to disagree about.
        return None
    return float(krippendorff.alpha(
        value_counts=pairable[:, given], value_domain=levels[given], level_of_measurement=scale
    ))  # fmt: skip

"""How far raters agree: Krippendorff's alpha, with an interval over pairs drawn anew."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from rigid.frontier.intervals import Interval

Scale = Literal["nominal", "ordinal"]


class Agreement(NamedTuple):
    """1: all agree; 0: as if by chance; below: less than that."""

    alpha: float | None
    """None where it is undefined: fewer than two raters of one thing, or always one answer."""
    interval: Interval | None
    """By bootstrap over pairs, percentiles; None for fewer than five pairs."""
    raters: int
    pairs: int


def agreement(
    values: Float[np.ndarray, " n"],
    raters: Int[np.ndarray, " n"],
    units: Int[np.ndarray, " n"],
    pairs: Int[np.ndarray, " n"],
    *,
    scale: Scale,
    resamples: int,
    rng: np.random.Generator,
    confidence: float = 0.95,
) -> Agreement:
    """Krippendorff's alpha of answers (Content Analysis, chapter 12), with a bootstrap interval.

    Pairs are drawn anew, whole: both members of a pair stay together. The raters are those who
    took part, since few of them cannot be resampled.

    Args:
        values: Answers. Shape (n,).
        raters: Who gave each. Shape (n,).
        units: What each is about: a pair, or one member of a pair. Shape (n,).
        pairs: The pair that it belongs to. Shape (n,).
        scale: `ordinal` weighs disagreements by how many answers lie between.
        resamples: Of the bootstrap.
        rng: Draws them.
        confidence: Nominal cover.
    """
    _, rater = np.unique(raters, return_inverse=True)
    names, unit = np.unique(units, return_inverse=True)
    levels, level = np.unique(values, return_inverse=True)
    of_pair = np.zeros(len(names), dtype=int)
    of_pair[unit] = np.unique(pairs, return_inverse=True)[1]
    counts = np.zeros((len(names), len(levels)), dtype=int)
    np.add.at(counts, (unit, level), 1)
    pair_count = int(of_pair.max()) + 1 if len(names) else 0
    people = int(rater.max()) + 1 if len(rater) else 0
    alpha = _alpha(counts, levels, scale)
    if alpha is None or pair_count < 5:
        return Agreement(alpha, None, people, pair_count)
    members = [np.flatnonzero(of_pair == pair) for pair in range(pair_count)]

    def again() -> float | None:
        drawn = rng.integers(pair_count, size=pair_count)
        return _alpha(counts[np.concatenate([members[pair] for pair in drawn])], levels, scale)

    drawn = [again() for _ in range(resamples)]
    known = [value for value in drawn if value is not None]
    if len(known) < len(drawn) / 2:
        return Agreement(alpha, None, people, pair_count)
    tail = (1 - confidence) / 2
    low, high = np.quantile(known, [tail, 1 - tail]).tolist()
    return Agreement(alpha, Interval(low, high), people, pair_count)


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

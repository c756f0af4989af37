"""Means of judgements in which the same raters and the same pairs occur again and again.

Answers of one rater are alike, and so are answers about one pair. An interval that takes them for
independent promises too much: raters and pairs are both drawn, and either may be drawn anew.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int
from scipy.special import stdtrit

from rigid.frontier.intervals import Interval

_Values = Float[np.ndarray, " n"]
_Groups = Int[np.ndarray, " n"]


class ClusteredMean(NamedTuple):
    """A mean over answers, with what is known of its error."""

    mean: float
    se: float | None
    """Standard error, for raters and pairs drawn anew; None where there is one of either."""
    freedom: float | None
    """Degrees of freedom of Student's t."""
    answers: int
    raters: int
    pairs: int

    def interval(self, confidence: float, bounds: tuple[float, float]) -> Interval | None:
        """Student's t interval, clipped to `bounds`."""
        if self.se is None or self.freedom is None:
            return None
        reach = float(stdtrit(self.freedom, (1 + confidence) / 2)) * self.se
        low, high = np.clip([self.mean - reach, self.mean + reach], *bounds).tolist()
        return Interval(low, high)


def clustered_mean(values: _Values, raters: _Groups, pairs: _Groups) -> ClusteredMean:
    """The mean of `values`, with the error of raters *and* pairs drawn anew.

    Answer i is taken as μ + a_rater + b_pair + e_i, all random. With V_A, V_B the variances of the
    mean clustered by rater and by pair alone and V_E that of what both leave, V_A + V_B - V_E
    estimates its variance (Cameron, Gelbach & Miller, J. Bus. Econ. Stat. 29, 2011) and
    Satterthwaite's formula its degrees of freedom. The estimate is kept above each of V_A, V_B and
    the variance of independent answers, since a difference of variances can fall to nothing by
    chance. Where every rater judged every pair this is `frontier.crossed.crossed_interval`.

    Args:
        values: Answers. Shape (n,), n >= 1.
        raters: Who gave each, as numbers of any kind. Shape (n,).
        pairs: Of which pair each is. Shape (n,).

    Raises:
        ValueError: There are none, or they are not finite.

    Example:
        >>> raters, pairs = np.divmod(np.arange(4), 2)
        >>> found = clustered_mean(np.array([1.0, 0.0, 1.0, 1.0]), raters, pairs)
        >>> found.mean, round(found.se, 2)
        (0.75, 0.25)
    """
    if not len(values) or not np.isfinite(values).all():
        raise ValueError(f"values must be finite numbers, at least one, got {values.tolist()}")
    _, rater = np.unique(raters, return_inverse=True)
    _, pair = np.unique(pairs, return_inverse=True)
    counts = (len(values), int(rater.max()) + 1, int(pair.max()) + 1)
    mean = float(values.mean())
    if min(counts[1:]) < 2:
        return ClusteredMean(mean, None, None, *counts)
    variance, freedom = _variance(values - mean, rater, pair)
    return ClusteredMean(mean, variance**0.5, freedom, *counts)


def _variance(residual: _Values, rater: _Groups, pair: _Groups) -> tuple[float, float]:
    """Variance of the mean and its degrees of freedom."""
    n = len(residual)
    by_rater, of_raters = _by_group(residual, rater)
    by_pair, of_pairs = _by_group(residual, pair)
    candidates = [
        (by_rater, of_raters), (by_pair, of_pairs), (float(residual.var(ddof=1)) / n, n - 1.0),
    ]  # fmt: skip
    left, freedom = _left_by_both(residual, rater, pair)
    both = by_rater + by_pair - left
    if freedom > 0 and both > 0:
        spread = by_rater**2 / of_raters + by_pair**2 / of_pairs + left**2 / freedom
        if spread > 0:
            candidates.append((both, max(both**2 / spread, 1.0)))
    return max(candidates)


def _by_group(residual: _Values, group: _Groups) -> tuple[float, float]:
    sums = np.bincount(group, weights=residual)
    count = len(sums)
    return float((sums**2).sum()) * count / (count - 1) / len(residual) ** 2, count - 1.0


def _left_by_both(residual: _Values, rater: _Groups, pair: _Groups) -> tuple[float, float]:
    """Variance of the mean from what an additive fit of raters and pairs leaves; 0 of none."""
    n, raters = len(residual), int(rater.max()) + 1
    size = raters + int(pair.max()) + 1
    normal = np.zeros((size, size))  # Of the least-squares fit; solved by its rank, which lacks 1.
    for one in (rater, raters + pair):
        for other in (rater, raters + pair):
            np.add.at(normal, (one, other), 1.0)
    sums = np.bincount(rater, residual, size) + np.bincount(raters + pair, residual, size)
    fitted, _, rank, _ = np.linalg.lstsq(normal, sums, rcond=None)
    freedom = float(n - rank)
    if freedom <= 0:
        return 0.0, 0.0
    left = residual - fitted[rater] - fitted[raters + pair]
    return float((left**2).sum()) / freedom / n, freedom

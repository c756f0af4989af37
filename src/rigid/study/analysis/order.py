"""Two robots or more: are those that measure worse also those that fail more with people?

The paper calls its numbers 'predictive of deployment' after two robots. People meet all robots, so
that each is its own control. Under the hypothesis that robots are alike to people, whoever fails
with which robot is exchangeable within each person: that is what the permutations do.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations as orders_of
from itertools import product
from math import factorial
from typing import Literal

import numpy as np
from jaxtyping import Float

from rigid.frontier.intervals import Interval, t_interval

Verdict = Literal["same order", "opposite order", "cannot be told apart", "unknown"]


@dataclass(frozen=True, kw_only=True)
class PeopleDifference:
    """How much more often robot `b` fails with people than robot `a`."""

    people: int
    """Who met both."""
    mean: float | None
    interval: Interval | None
    """Student's t over people."""
    p: float | None
    """Two-sided, by permutation within each person."""


def people_difference(
    a: Float[np.ndarray, " n"],
    b: Float[np.ndarray, " n"],
    *,
    permutations: int,
    rng: np.random.Generator,
    confidence: float = 0.95,
) -> PeopleDifference:
    """Compares two robots by people who met both.

    Args:
        a: For each person the share of episodes in which the first robot failed. Shape (n,).
        b: The same of the second robot and the same people. Shape (n,).
        permutations: Draws, where there are more permutations than that.
        rng: Draws them.
        confidence: Of the interval.

    Example:
        >>> a, b = np.zeros(6), np.full(6, 0.5)
        >>> people_difference(a, b, permutations=100, rng=np.random.default_rng(0)).p
        0.03125
    """
    if not len(a):
        return PeopleDifference(people=0, mean=None, interval=None, p=None)
    apart = b - a
    table = np.stack([a, b], axis=1)
    p = order_test(table, np.array([0.0, 1.0]), permutations=permutations, rng=rng)
    return PeopleDifference(
        people=len(a), mean=float(apart.mean()), p=p,
        interval=t_interval(apart, confidence, bounds=(-1.0, 1.0)),
    )  # fmt: skip


def order_test(
    failures: Float[np.ndarray, "n r"],
    headline: Float[np.ndarray, " r"],
    *,
    permutations: int,
    rng: np.random.Generator,
) -> float:
    """Two-sided p-value of failures that have nothing to do with the headline number of robots.

    The statistic is the sum over people of the covariance of failures with the ranks of the
    headline; robots are exchanged within people. Exact where there are few enough permutations.

    Args:
        failures: People by robots.
        headline: A number of each robot; only its order counts.
        permutations: Draws, where there are more permutations than that.
        rng: Draws them.
    """
    people, robots = failures.shape
    weights = _ranks(headline)
    orders = _orders(robots)
    sums = failures[:, orders] @ weights  # People by permutations of the robots.
    seen = float((failures @ weights).sum())
    if factorial(robots) ** people <= permutations:
        choices = np.array(list(product(range(len(orders)), repeat=people)))
        null = sums[np.arange(people), choices].sum(axis=1)
        return float((np.abs(null) >= abs(seen) - 1e-9).mean())
    drawn = rng.integers(len(orders), size=(permutations, people))
    null = sums[np.arange(people), drawn].sum(axis=1)
    # What was seen is one of the permutations, so that no p is 0.
    return float(((np.abs(null) >= abs(seen) - 1e-9).sum() + 1) / (permutations + 1))


def verdict(headline: Interval | None, people: PeopleDifference, *, alpha: float) -> Verdict:
    """Whether both differences have the same sign, as far as they have one at all.

    Args:
        headline: Of the difference of the headline numbers, over search seeds; None for one seed.
        people: Of the failures.
        alpha: Size of the test.
    """
    if headline is None or people.p is None or people.mean is None:
        return "unknown"
    if headline.low <= 0.0 <= headline.high or people.p >= alpha:
        return "cannot be told apart"
    return "same order" if (headline.low > 0.0) == (people.mean > 0.0) else "opposite order"


def _ranks(values: Float[np.ndarray, " r"]) -> Float[np.ndarray, " r"]:
    """Ranks about their mean; equal values share theirs."""
    _, place, counts = np.unique(values, return_inverse=True, return_counts=True)
    middle = np.cumsum(counts) - (counts - 1) / 2
    ranks: Float[np.ndarray, " r"] = middle[place] - middle[place].mean()
    return ranks


def _orders(robots: int) -> np.ndarray:
    return np.array(list(orders_of(range(robots))))

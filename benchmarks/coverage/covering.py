"""How often intervals hold the truth: the count, and three ways to draw what they are made of."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from benchmarks.coverage.ends import Bounds, Ends

_ROUNDING = 1e-12
"""The mean of equal values may differ from them in the last digits."""


class Cover(NamedTuple):
    """What the intervals of many draws did; shares in [0, 1]."""

    cover: float
    error: float
    """Of `cover`, from the number of draws: one standard error."""
    above: float
    """Share of intervals that lie wholly below the truth: 2.5 % is nominal."""
    below: float
    """Share that lie wholly above it."""
    width: float
    """Mean width."""


def cover_of(ends: Float[np.ndarray, "2 d"], truth: float) -> Cover:
    """Counts the intervals that hold `truth`.

    Example:
        >>> found = cover_of(np.array([[0.0, 0.4, 0.6, 0.2], [0.3, 0.6, 0.9, 0.6]]), 0.5)
        >>> found.cover, found.above, found.below, round(found.width, 3)
        (0.5, 0.25, 0.25, 0.3)
    """
    low, high = ends
    above, below = high < truth - _ROUNDING, low > truth + _ROUNDING
    cover = float((~above & ~below).mean())
    error = float(np.sqrt(cover * (1.0 - cover) / len(low)))
    return Cover(cover, error, float(above.mean()), float(below.mean()), float((high - low).mean()))


def with_replacement(
    population: int, size: int, draws: int, rng: np.random.Generator
) -> Int[np.ndarray, "n d"]:
    """Indices of independent draws, so that the results at hand stand for the law itself."""
    return rng.integers(population, size=(size, draws))


def without_replacement(
    population: int, size: int, draws: int, rng: np.random.Generator
) -> Int[np.ndarray, "n d"]:
    """Indices of draws that name nobody twice."""
    if not 0 < size < population:
        raise ValueError(f"a draw of {size} needs a population of more, got {population}")
    order = np.argpartition(rng.random((draws, population)), size, axis=1)
    return order[:, :size].T


def as_if_unlimited(
    values: Float[np.ndarray, "n d"], truth: float, population: int
) -> Float[np.ndarray, "n d"]:
    """Draws without replacement, each moved so that its mean errs as one of independent draws.

    The mean of n of N without replacement varies by 1 - n/N less than that of n independent draws,
    while the spread within a draw is the same: left as they are, intervals would cover too often.

    Example:
        >>> as_if_unlimited(np.array([[0.5], [0.7]]), 0.5, population=8).round(4).ravel().tolist()
        [0.5155, 0.7155]
    """
    farther = 1.0 / np.sqrt(1.0 - len(values) / population)
    moved: Float[np.ndarray, "n d"] = values + (values.mean(axis=0) - truth) * (farther - 1.0)
    return moved


def error_of_results(
    results: Float[np.ndarray, " N"], size: int, ends: Ends, bounds: Bounds, *,
    redraws: int, draws: int, rng: np.random.Generator,
) -> float:  # fmt: skip
    """Standard error of a cover from having just these results: they are drawn again themselves.

    The part of that spread that a finite number of draws makes is taken off.
    """
    covers = []
    for _ in range(redraws):
        again = results[rng.integers(len(results), size=len(results))]
        sample = again[with_replacement(len(again), size, draws, rng)]
        covers.append(cover_of(ends(sample, bounds), float(again.mean())).cover)
    mean = float(np.mean(covers))
    spread = float(np.var(covers, ddof=1)) - mean * (1 - mean) / draws
    return float(np.sqrt(max(spread, 0.0)))

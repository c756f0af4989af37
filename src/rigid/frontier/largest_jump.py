"""Where to look next: the λ-interval over which naturalness rises most.

Implements LARGEST-JUMP (paper, Alg. 2) and the placement of λ that RIGID builds on it (Alg. 1).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Real

_Values = Real[np.ndarray, " n"] | Sequence[float | int]

TIE = 1e-9
"""Closer than this, two rises, two gaps in log λ or two λ (relative) are the same."""


class LambdaInterval(NamedTuple):
    """A search interval over the naturalness weight λ (dimensionless), lower < upper."""

    lower: float
    upper: float


def largest_jump(lambdas: _Values, naturalness: _Values, window: int = 2) -> LambdaInterval:
    """Returns the λ-interval with the largest rise in naturalness.

    With points sorted by λ, L = `window` and S = `naturalness` (paper, Alg. 2):

        lowᵢ = min S[max(i+1-L, 0) : i+1],   highᵢ = max S[i : i+L],
        i*   = argmaxᵢ (highᵢ - lowᵢ).

    The result spans the λ's that attain low and high at i*, the first of each where values repeat.
    Naturalness is noisy, so both ends are searched within a window and need not be neighbours. Of
    equal rises the one at the larger λ wins, since Alg. 2 scans downwards with a strict `>`.

    Departures from Alg. 2, whose printing mixes 0- and 1-based indices:
      * the `i = 1` special cases are dropped; the window slices already cover them;
      * `high` is indexed by i (Alg. 2 appends it in reverse and never reverses it);
      * when naturalness nowhere rises (Alg. 2: an empty interval), the widest gap between adjacent
        log λ is returned, of equal ones that at the larger λ, so that the search continues;
      * rises equal up to rounding (`TIE`) count as equal, or rounding would choose the interval.

    Args:
        lambdas: Weights trained so far, any order, distinct, finite and > 0. Shape (n,), n >= 2.
        naturalness: Headline naturalness of each, in [0, 1]. Shape (n,).
        window: Sliding-window length L, in points; at least 2. Ours: the paper gives no value, and
            3 of 6 points already span most of the range.

    Raises:
        ValueError: `lambdas` are fewer than 2, not distinct, not finite or not > 0; `naturalness`
            differs in shape or leaves [0, 1] (NaN included); or `window` is below 2.

    Example:
        >>> largest_jump([1.0, 0.01, 0.1], [0.9, 0.1, 0.2], window=2)
        LambdaInterval(lower=0.01, upper=1.0)
    """
    if window < 2:
        raise ValueError(f"window must be at least 2 points, got {window}")
    ascending, scores = _sorted_by_lambda(lambdas, naturalness)

    largest_rise, jump = 0.0, None
    for i in reversed(range(len(scores))):
        start = max(i + 1 - window, 0)
        low = start + int(np.argmin(scores[start : i + 1]))
        high = i + int(np.argmax(scores[i : i + window]))
        rise = float(scores[high] - scores[low])
        if rise > largest_rise + TIE:
            largest_rise, jump = rise, LambdaInterval(ascending[low], ascending[high])
    return jump or _widest_gap(ascending)


def first_lambdas(lower: float, upper: float, count: int) -> list[float]:
    """Returns the λ of the first round: evenly spaced in log λ, both ends included (paper, Alg. 1).

    Args:
        lower: Smallest λ, dimensionless; finite, > 0 and below `upper`.
        upper: Largest λ, dimensionless.
        count: How many, at least 2.

    Raises:
        ValueError: The ends are not 0 < lower < upper < ∞, or `count` is below 2.

    Example:
        >>> first_lambdas(0.01, 1.0, 3)
        [0.01, 0.1, 1.0]
    """
    _check_ends(lower, upper)
    if count < 2:
        raise ValueError(f"count must be at least 2 to include both ends, got {count}")
    spaced: list[float] = np.geomspace(lower, upper, count).tolist()
    return spaced


def next_lambdas(
    trained: Collection[float | int], interval: tuple[float, float], count: int
) -> list[float]:
    """Returns the λ of a later round: evenly spaced inside the interval of the largest jump.

    Ours: Alg. 1 spaces its k values over the interval with both ends and so trains two known λ
    again; here all k lie in the interior. One that coincides with a trained λ moves to the middle
    of the widest gap in log λ that trained and newly placed values leave inside the interval (of
    equal gaps the one at the larger λ).

    Args:
        trained: Weights trained so far, any order; those outside the interval do not matter, so
            0 and ∞ may be among them.
        interval: Ends of the search interval, 0 < lower < upper < ∞.
        count: How many, at least 1.

    Returns:
        `count` ascending λ (dimensionless), none trained before.

    Raises:
        ValueError: The ends are not 0 < lower < upper < ∞, `count` is below 1, `trained` holds NaN,
            or the interval is too narrow for another distinct λ.

    Example:
        >>> next_lambdas([0.01, 1.0], (0.01, 1.0), 1)
        [0.1]
    """
    lower, upper = interval
    _check_ends(lower, upper)
    if count < 1:
        raise ValueError(f"count must be at least 1, got {count}")
    if any(math.isnan(value) for value in trained):
        raise ValueError(f"trained must not contain NaN, got {list(trained)}")

    known = [float(value) for value in trained if lower < value < upper]
    taken = [float(lower), *known, float(upper)]
    placed: list[float] = []
    for value in np.geomspace(lower, upper, count + 2)[1:-1].tolist():
        if not any(math.isclose(value, other, rel_tol=TIE) for other in taken):
            placed.append(value)
    # Free places first, so that a moved λ never lands where an evenly spaced one will stand.
    while len(placed) < count:
        placed.append(_middle(_widest_gap(sorted(taken + placed))))
    return sorted(placed)


def _sorted_by_lambda(
    lambdas: object, naturalness: object
) -> tuple[list[float], Float[np.ndarray, " n"]]:
    given = np.asarray(lambdas, dtype=float)
    scores = np.asarray(naturalness, dtype=float)
    if given.ndim != 1 or len(given) < 2:
        raise ValueError(f"lambdas must be at least 2 values in one row, got shape {given.shape}")
    if scores.shape != given.shape:
        raise ValueError(
            f"naturalness must have one value per λ, got shape {scores.shape} for {len(given)} λ"
        )
    for value in given[~((given > 0.0) & (given < math.inf))]:
        raise ValueError(f"lambdas must be finite and > 0, since λ is searched in log, got {value}")
    for value in scores[~((scores >= 0.0) & (scores <= 1.0))]:
        raise ValueError(f"naturalness must lie in [0, 1], got {value}")
    order = np.argsort(given)
    ascending = given[order].tolist()
    for value, following in pairwise(ascending):
        if value == following:
            raise ValueError(f"lambdas must be distinct, got {value} more than once")
    return ascending, scores[order]


def _check_ends(lower: float, upper: float) -> None:
    if not 0.0 < lower < upper < math.inf:
        raise ValueError(f"lower and upper must satisfy 0 < lower < upper < ∞: {lower}, {upper}")


def _widest_gap(ascending: list[float]) -> LambdaInterval:
    """Returns the widest gap between adjacent log λ; of equal ones, that at the larger λ."""
    widths = np.diff(np.log(ascending))
    last = int(np.flatnonzero(widths >= widths.max() - TIE)[-1])
    return LambdaInterval(ascending[last], ascending[last + 1])


def _middle(gap: LambdaInterval) -> float:
    middle = math.sqrt(gap.lower) * math.sqrt(gap.upper)
    if any(math.isclose(middle, end, rel_tol=TIE) for end in gap):
        raise ValueError(f"interval has no room for another λ, widest gap: {tuple(gap)}")
    return middle

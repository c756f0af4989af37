"""Whether one kind of play really earns less than another, or only by chance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

DEVIATIONS = 3.0
"""Standard errors by which a mean has to be lower: by chance one time in 740. Ours."""


def mean_and_error(groups: Sequence[Float[np.ndarray, " _n"]]) -> tuple[float, float]:
    """Mean of the groups' means, and its standard error over episodes.

    Args:
        groups: Returns of each human of one kind, such as the adversary of each seed.

    Example:
        >>> mean_and_error([np.array([0.0, 2.0]), np.array([4.0, 6.0])])
        (3.0, 0.7071067811865476)
    """
    errors = [float(np.var(group, ddof=1)) / len(group) if len(group) > 1 else 0.0
              for group in groups]  # fmt: skip
    mean = float(np.mean([np.mean(group) for group in groups]))
    return mean, float(np.sqrt(np.sum(errors))) / len(groups)


def deviations_below(
    other: Sequence[Float[np.ndarray, " _n"]], canonical: Float[np.ndarray, " _n"]
) -> float:
    """By how many standard errors a kind of play earns less than canonical play; negative: more.

    Infinite where both never vary and still differ.

    Example:
        >>> deviations_below([np.array([1.0, 1.0])], np.array([2.0, 2.0]))
        inf
        >>> deviations_below([np.array([2.0, 2.0])], np.array([2.0, 2.0]))
        0.0
    """
    high, high_error = mean_and_error([canonical])
    low, low_error = mean_and_error(other)
    gap, error = high - low, float(np.hypot(high_error, low_error))
    if abs(gap) <= 1e-6 * max(abs(high), abs(low)):  # Rounding of 32-bit sums.
        return 0.0
    return float(np.copysign(np.inf, gap)) if error == 0 else gap / error

"""The mean over robots of one recipe and over search seeds, with an interval that knows of both.

Robots of a recipe differ, and so do searches: a claim about the recipe has to allow for both. Every
robot is searched with the same seeds, so values form a table, robots by seeds, without gaps.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit

from rigid.frontier.intervals import Interval, check_confidence, t_interval


def crossed_interval(
    values: Float[np.ndarray, "R S"],
    confidence: float = 0.95,
    bounds: tuple[float, float] = (0.0, 1.0),
) -> Interval | None:
    """Returns an interval of the mean of robots drawn anew and searched with seeds drawn anew.

    The value of robot r with seed s is taken as μ + a_r + b_s + e_rs, all random. With the mean
    squares of a two-way layout, (MS_R + MS_S - MS_E) / RS estimates the variance of the mean, and
    Satterthwaite's formula its degrees of freedom (Searle, Casella & McCulloch, 'Variance
    Components', 1992, chapter 4). The estimate is kept above those of each factor alone, since a
    difference of mean squares can fall to nothing by chance (ours). With one robot it is the t
    interval over seeds, which then says nothing of other robots; with one seed that over robots.

    Args:
        values: One value for each robot and search seed.
        confidence: Nominal cover, in (0, 1).
        bounds: Least and largest possible mean.

    Returns:
        None for a single value.

    Raises:
        ValueError: `values` are no table, not finite, or `confidence` is not in (0, 1).

    Example:
        >>> table = np.array([[0.4, 0.5, 0.6], [0.5, 0.6, 0.7], [0.3, 0.4, 0.5]])
        >>> low, high = crossed_interval(table)
        >>> round(low, 2), round(high, 2)
        (0.27, 0.73)
    """
    table = np.asarray(values, dtype=float)
    if table.ndim != 2 or not table.size or not np.isfinite(table).all():
        raise ValueError(f"values must be a finite table, robots by seeds, got {table.tolist()}")
    check_confidence(confidence)
    if 1 in table.shape:
        return t_interval(table.ravel(), confidence, bounds)
    variance, freedom = _variance_of_the_mean(table)
    reach = float(stdtrit(freedom, (1 + confidence) / 2)) * variance**0.5
    low, high = np.clip([table.mean() - reach, table.mean() + reach], *bounds).tolist()
    return Interval(low, high)


def _variance_of_the_mean(table: Float[np.ndarray, "R S"]) -> tuple[float, float]:
    """Estimated variance of the mean of the table, and its degrees of freedom."""
    robots, seeds = table.shape
    by_robot, by_seed = table.mean(axis=1), table.mean(axis=0)
    rest = table - by_robot[:, None] - by_seed + table.mean()
    of_robots = seeds * by_robot.var(ddof=1)
    of_seeds = robots * by_seed.var(ddof=1)
    of_rest = float((rest**2).sum()) / ((robots - 1) * (seeds - 1))
    both = of_robots + of_seeds - of_rest
    spread = (
        of_robots**2 / (robots - 1)
        + of_seeds**2 / (seeds - 1)
        + of_rest**2 / ((robots - 1) * (seeds - 1))
    )
    candidates = [(of_robots, robots - 1.0), (of_seeds, seeds - 1.0)]
    if both > 0 and spread > 0:
        candidates.append((both, max(both**2 / spread, 1.0)))
    mean_square, freedom = max(candidates)
    return mean_square / table.size, freedom

"""The interval over robots and search seeds: known cases, and its cover on a known law."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.frontier.crossed import crossed_interval
from rigid.frontier.intervals import t_interval

WIDE = (-10.0, 10.0)


@pytest.mark.parametrize("axis", [0, 1])
def test_with_one_robot_or_one_seed_it_is_the_t_interval_over_the_other(axis):
    row = [0.4, 0.5, 0.7]
    table = np.expand_dims(np.array(row), axis)
    assert crossed_interval(table) == t_interval(row)


def test_a_single_value_has_no_interval():
    assert crossed_interval(np.array([[0.5]])) is None


def test_searches_that_all_agree_leave_the_robots_as_unit():
    """Eight equal searches of three robots are no more than three values."""
    robots = [0.4, 0.5, 0.7]
    table = np.repeat(np.array(robots)[:, None], 8, axis=1)
    assert crossed_interval(table) == pytest.approx(t_interval(robots))


def test_robots_that_all_agree_leave_the_seeds_as_unit():
    seeds = [0.1, 0.2, 0.25, 0.4]
    assert crossed_interval(np.tile(seeds, (3, 1))) == pytest.approx(t_interval(seeds))


@pytest.mark.parametrize("deviations", [(0.3, 0.0, 0.3), (0.0, 0.3, 0.3), (0.2, 0.2, 0.2)])
def test_it_covers_the_mean_as_often_as_it_says(deviations):
    """Three robots and eight seeds, drawn 2,000 times from a crossed normal law of mean 0."""
    of_robots, of_seeds, of_rest = deviations
    rng = np.random.default_rng(0)
    covered = []
    for _ in range(2000):
        table = (
            of_robots * rng.standard_normal((3, 1))
            + of_seeds * rng.standard_normal((1, 8))
            + of_rest * rng.standard_normal((3, 8))
        )
        low, high = crossed_interval(table, bounds=WIDE)
        covered.append(low <= 0 <= high)
    assert 0.93 <= np.mean(covered) <= 0.995


def test_what_is_no_table_is_refused():
    with pytest.raises(ValueError, match="must be a finite table, robots by seeds"):
        crossed_interval(np.array([[0.1, np.nan]]))

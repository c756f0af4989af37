"""Intervals over episodes, on cases with known answers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binomtest

from benchmarks.physics.intervals import mean, relative, share, share_difference
from rigid.frontier.intervals import t_interval


def test_the_interval_of_a_mean_is_students_and_has_no_bounds():
    values = np.array([4.0, 5.0, 6.0])
    assert mean(values + 100)[1:] == pytest.approx(
        np.array(t_interval(values / 10)) * 10 + 100, rel=1e-9
    )


def test_one_value_has_no_interval():
    with pytest.raises(ValueError, match="one value has no interval"):
        mean(np.array([1.0]))


def test_a_ratio_that_all_episodes_share_is_certain():
    reference = np.array([1.0, 3.0, 7.0])
    assert relative(1.1 * reference, reference) == pytest.approx((0.1, 0.1, 0.1))


def test_intervals_of_a_ratio_cover():
    rng, held = np.random.default_rng(0), 0
    for _ in range(1000):
        reference = rng.gamma(4.0, size=60)
        found = relative(1.2 * reference + rng.normal(0, 1, 60), reference)
        held += found.low <= 0.2 <= found.high
    assert held == pytest.approx(950, abs=4 * 7)


@pytest.mark.parametrize("count", [0, 1, 7, 20])
def test_the_interval_of_a_share_is_that_of_clopper_and_pearson(count):
    found = share(np.repeat([1.0, 0.0], [count, 20 - count]))
    exact = binomtest(count, 20).proportion_ci(method="exact")
    assert found == pytest.approx((count / 20, exact.low, exact.high))


def test_a_difference_of_shares_changes_its_sign_with_its_order():
    mine, theirs = np.array([1.0, 1, 1, 0]), np.array([0.0, 0, 1, 1])
    found, opposite = share_difference(mine, theirs), share_difference(theirs, mine)
    assert found.value == 0.25
    assert found == pytest.approx([-opposite.value, -opposite.high, -opposite.low])


def test_intervals_of_a_paired_difference_of_shares_cover():
    rng, held = np.random.default_rng(0), 0
    for _ in range(1000):
        both = rng.choice(4, size=200, p=[0.8, 0.12, 0.05, 0.03])
        found = share_difference(np.isin(both, [0, 1]) * 1.0, np.isin(both, [0, 2]) * 1.0)
        held += found.low <= 0.07 <= found.high
    assert held == pytest.approx(950, abs=4 * 7)

"""Rank correlation: hand-computed cases, and SciPy's answers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from benchmarks.prediction.correlation import (
    Resamples,
    kendall,
    partial_kendall,
    percentile_interval,
    permutation_p,
    resample,
    spearman,
)

UP = np.array([1.0, 2.0, 3.0, 4.0])
SWAPPED = np.array([1.0, 3.0, 2.0, 4.0])
TIED = np.array([1.0, 1.0, 2.0, 3.0])


def test_one_pair_out_of_order_costs_kendall_a_third_of_four_robots():
    assert kendall(UP, SWAPPED) == pytest.approx((5 - 1) / 6)


def test_a_tie_shrinks_the_pairs_of_tau_b():
    assert kendall(UP, TIED) == pytest.approx(5 / np.sqrt(6 * 5))


def test_spearman_is_one_minus_six_squared_rank_differences():
    assert spearman(UP, SWAPPED) == pytest.approx(1 - 6 * 2 / (4 * 15))


def test_reversed_robots_correlate_by_minus_one():
    assert (kendall(UP, -UP), spearman(UP, -UP)) == (-1, -1)


@pytest.mark.parametrize("statistic", [kendall, spearman])
def test_robots_that_do_not_differ_have_no_correlation(statistic):
    assert np.isnan(statistic(UP, np.ones(4)))


@pytest.mark.parametrize(
    ("statistic", "oracle"), [(kendall, stats.kendalltau), (spearman, stats.spearmanr)]
)
def test_every_resample_gets_what_scipy_says(statistic, oracle):
    rng = np.random.default_rng(0)
    x, y = rng.integers(6, size=(2, 30, 9)).astype(float)  # With ties.
    expected = [oracle(*pair).statistic for pair in zip(x, y, strict=True)]
    np.testing.assert_allclose(statistic(x, y), expected)


def test_partial_tau_by_hand():
    given = np.array([2.0, 1.0, 3.0, 4.0])
    xy, xz, yz = 2 / 3, 2 / 3, 1 / 3
    by_hand = (xy - xz * yz) / np.sqrt((1 - xz**2) * (1 - yz**2))
    assert partial_kendall(UP, SWAPPED, given) == pytest.approx(by_hand)


def test_nothing_can_be_added_to_a_number_that_orders_alike():
    assert np.isnan(partial_kendall(UP, SWAPPED, UP))


def test_the_p_of_four_robots_in_perfect_order_is_two_of_24_orders():
    p = permutation_p(UP, UP**3, kendall, np.random.default_rng(0))
    assert p == pytest.approx(2 / 24)


def test_p_is_unknown_where_robots_do_not_differ():
    assert permutation_p(UP, np.ones(4), kendall, np.random.default_rng(0)) is None


def test_p_by_chance_lies_near_scipys_exact_one():
    rng = np.random.default_rng(1)
    x, y = rng.normal(size=(2, 10))
    exact = stats.kendalltau(x, y, method="exact").pvalue
    assert permutation_p(x, y, kendall, rng) == pytest.approx(exact, abs=0.02)


def test_an_interval_leaves_out_what_is_undefined():
    values = np.array([np.nan, *np.linspace(0, 1, 101)])
    assert percentile_interval(values, confidence=0.9) == pytest.approx((0.05, 0.95))


def test_there_is_no_interval_where_all_is_undefined():
    assert percentile_interval(np.full(3, np.nan)) is None


def test_a_resample_takes_the_redraw_of_the_robot_that_it_took():
    drawn = Resamples(np.array([[1, 1, 0]]), np.array([[0, 1, 1]]))
    redrawn = np.array([[0.0, 1.0], [10.0, 11.0]])
    assert drawn.of_redrawn(redrawn).tolist() == [[10.0, 11.0, 1.0]]


def test_resampling_seeds_alone_keeps_the_robots():
    drawn = resample(3, 5, 2, np.random.default_rng(0)).same_robots()
    assert drawn.of(np.array([7.0, 8.0, 9.0])).tolist() == [[7.0, 8.0, 9.0]] * 2


def test_of_normal_samples_of_twelve_the_interval_covers_what_it_says():
    rng = np.random.default_rng(0)
    correlation, samples, hits = 0.8, 200, 0
    for _ in range(samples):
        x, noise = rng.normal(size=(2, 12))
        y = correlation * x + np.sqrt(1 - correlation**2) * noise
        drawn = resample(12, 1, 400, rng)
        low, high = percentile_interval(kendall(drawn.of(x), drawn.of(y)))
        hits += low <= 2 / np.pi * np.arcsin(correlation) <= high
    assert 0.93 <= hits / samples <= 1

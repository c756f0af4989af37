"""Intervals: against SciPy, by hand, and by their measured cover."""

from __future__ import annotations

import inspect
import math

import numpy as np
import pytest
import scipy.stats

from rigid.frontier.intervals import (
    Interval,
    bca_interval,
    both_scales_ends,
    paired_difference,
    t_interval,
    upper_bound,
)

EVERYWHERE = (-math.inf, math.inf)


def generator() -> np.random.Generator:
    return np.random.default_rng(7)


@pytest.mark.parametrize("confidence", [0.5, 0.95, 0.99])
@pytest.mark.parametrize("values", [[0.1, 0.6], [0.4, 0.5, 0.6], [0.2, 0.9, 0.4, 0.3, 0.35]])
def test_t_interval_agrees_with_scipy(values, confidence):
    expected = scipy.stats.t.interval(
        confidence, len(values) - 1, loc=np.mean(values), scale=scipy.stats.sem(values)
    )
    assert t_interval(values, confidence, EVERYWHERE) == pytest.approx(expected)


def test_t_interval_is_clipped_to_its_bounds():
    assert t_interval([0.0, 1.0]) == (0.0, 1.0)
    assert t_interval([-0.9, 0.9], bounds=(-1.0, 1.0)) == (-1.0, 1.0)


def test_one_value_has_no_interval():
    assert t_interval([0.4]) is None


def test_equal_values_have_an_interval_of_no_width():
    assert t_interval([0.25, 0.25, 0.25]) == (0.25, 0.25)
    assert bca_interval([0.25] * 30, generator()) == (0.25, 0.25)


def test_t_interval_of_three_seeds_covers_what_it_says():
    samples = generator().normal(0.5, 0.1, size=(2000, 3))
    intervals = [t_interval(sample, bounds=EVERYWHERE) for sample in samples]
    covered = np.mean([low <= 0.5 <= high for low, high in intervals])
    assert covered == pytest.approx(0.95, abs=0.015)


def test_the_upper_bound_of_skewed_values_is_that_of_their_logit():
    values = [0.01, 0.02, 0.06]
    mean, error = np.mean(values), scipy.stats.sem(values)
    stretched = scipy.stats.t.ppf(0.975, 2) * error / (mean * (1 - mean))
    assert upper_bound(values) == pytest.approx(
        scipy.special.expit(scipy.special.logit(mean) + stretched)
    )


def test_the_upper_bound_of_values_near_1_is_that_of_t():
    assert upper_bound([0.8, 0.85, 0.86]) == t_interval([0.8, 0.85, 0.86]).high < 1.0


def test_both_upper_ends_agree_on_symmetric_values_in_the_middle():
    values = [0.35, 0.4, 0.45]
    assert upper_bound(values) == pytest.approx(t_interval(values).high, abs=0.005)


def test_the_upper_bound_of_equal_values_is_their_value():
    assert [upper_bound([value] * 4) for value in (0.0, 0.25, 1.0)] == [0.0, 0.25, 1.0]


def test_the_upper_bound_grows_with_the_confidence():
    values = [0.1, 0.2, 0.4]
    assert upper_bound(values, 0.5) < upper_bound(values, 0.9) < upper_bound(values) < 1.0


def test_one_value_has_no_upper_bound():
    assert upper_bound([0.4]) is None


def test_an_upper_bound_is_for_shares():
    with pytest.raises(ValueError, match=r"values must lie in \[0, 1\], got \[-0\.2, 0\.1\]"):
        upper_bound([-0.2, 0.1])


def test_an_area_may_leave_the_shares_by_rounding():
    assert upper_bound([1.0, 1.0 + 2e-16]) == 1.0


def test_both_scales_of_many_draws_are_those_of_each():
    values = generator().beta(1, 9, size=(5, 7))
    together = both_scales_ends(values, 0.95, (0.0, 1.0))
    alone = [upper_bound(column) for column in values.T]
    assert together.shape == (2, 7)
    assert together[1].tolist() == pytest.approx(alone)


def test_bca_is_given_from_thirty_values_on():
    values = generator().beta(2, 5, size=30)
    assert bca_interval(values[:29], generator()) is None
    assert isinstance(bca_interval(values, generator()), Interval)


def test_bca_agrees_with_t_on_a_large_symmetric_sample():
    values = generator().normal(0.5, 0.1, size=200)
    assert bca_interval(values, generator()) == pytest.approx(t_interval(values), abs=2e-3)


def test_bca_leans_towards_the_tail_of_a_skewed_sample():
    values = generator().beta(1, 9, size=40)
    low, high = bca_interval(values, generator())
    assert high - values.mean() > 1.2 * (values.mean() - low)  # Percentiles lean by 1.08.


def test_bca_follows_the_generator_and_the_confidence():
    values = generator().beta(2, 5, size=30)
    first = bca_interval(values, generator())
    assert bca_interval(values, generator()) == first
    assert bca_interval(values, np.random.default_rng(8)) != first
    low, high = bca_interval(values, generator(), confidence=0.5)
    assert first.low < low < high < first.high


@pytest.mark.parametrize(
    ("values", "confidence", "message"),
    [
        ([], 0.95, r"values must be one row with at least one value, got shape \(0,\)"),
        ([[0.1, 0.2]], 0.95, r"values must be one row .*, got shape \(1, 2\)"),
        ([0.1, math.nan], 0.95, r"values must be finite, got \[0\.1, nan\]"),
        ([0.1, 0.2], 1.0, r"confidence must lie in \(0, 1\), got 1\.0"),
        ([0.1, 0.2], 0.0, r"confidence must lie in \(0, 1\), got 0\.0"),
    ],
)
def test_malformed_samples_are_refused(values, confidence, message):
    with pytest.raises(ValueError, match=message):
        inspect.unwrap(t_interval)(np.array(values), confidence)
    with pytest.raises(ValueError, match=message):
        inspect.unwrap(bca_interval)(np.array(values), generator(), confidence)


def test_paired_difference_uses_the_common_seeds_only():
    a = {0: 0.9, 1: 0.7, 2: 0.8, 5: 0.0}
    b = {2: 0.5, 1: 0.6, 0: 0.4, 9: 1.0}
    difference = paired_difference(a, b)
    assert difference.mean == pytest.approx(0.3)
    assert difference.seeds == (0, 1, 2)
    assert difference.interval == t_interval([0.9 - 0.4, 0.7 - 0.6, 0.8 - 0.5], bounds=(-1.0, 1.0))
    assert difference.interval.low < 0.0  # Not clipped at 0, unlike the interval of a share.


def test_pairing_removes_what_seeds_share():
    a = {"0": 0.1, "1": 0.5, "2": 0.9}
    b = {seed: value - 0.05 for seed, value in a.items()}
    mean, interval, _ = paired_difference(a, b)
    assert mean == pytest.approx(0.05)
    assert interval == pytest.approx((0.05, 0.05))


def test_confidence_reaches_the_paired_interval():
    a, b = {0: 0.9, 1: 0.7, 2: 0.8}, {0: 0.4, 1: 0.6, 2: 0.5}
    narrow = paired_difference(a, b, confidence=0.5).interval
    assert narrow == t_interval([0.9 - 0.4, 0.7 - 0.6, 0.8 - 0.5], 0.5, bounds=(-1.0, 1.0))


def test_one_common_seed_has_no_interval():
    assert paired_difference({0: 0.5}, {0: 0.7}).interval is None


def test_robots_without_a_common_seed_are_not_compared():
    with pytest.raises(ValueError, match=r"no common seed: a has \[0, 1\], b has \[2\]"):
        paired_difference({0: 0.1, 1: 0.2}, {2: 0.1})

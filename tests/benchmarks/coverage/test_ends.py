"""Ends of intervals: what each promises, on values whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import ksone

from benchmarks.coverage.covering import cover_of
from benchmarks.coverage.ends import (
    INTERVALS,
    bca,
    both_scales,
    guaranteed,
    printed,
    unpaired_too,
)
from benchmarks.coverage.laws import rare
from rigid.frontier.intervals import bca_interval, t_interval, upper_bound

SHARE, DIFFERENCE = (0.0, 1.0), (-1.0, 1.0)


def draws(size, count=20_000):
    return np.random.default_rng(3).normal(0.5, 0.05, size=(size, count))


def test_the_printed_interval_is_that_of_the_package():
    values = np.array([[0.02], [0.1], [0.3]])
    assert tuple(printed(values, SHARE)[:, 0]) == t_interval(values[:, 0])


def test_the_upper_end_of_both_scales_is_the_bound_that_the_gate_holds():
    values = np.array([[0.02], [0.1], [0.3]])
    assert both_scales(values, SHARE)[1, 0] == upper_bound(values[:, 0])


def test_bca_is_that_of_the_package():
    values = np.random.default_rng(0).beta(2, 5, size=(30, 1))
    expected = bca_interval(values[:, 0], np.random.default_rng(0))
    assert tuple(bca(values, SHARE)[:, 0]) == expected


@pytest.mark.parametrize("size", [3, 5, 8, 10])
@pytest.mark.parametrize("ends", [printed, both_scales])
def test_on_a_normal_law_cover_is_95_percent(ends, size):
    found = cover_of(ends(draws(size), SHARE), 0.5)
    assert found.cover == pytest.approx(0.95, abs=4 * 0.0015)


@pytest.mark.parametrize("bounds", [SHARE, DIFFERENCE])
def test_both_scales_never_lie_inside_the_printed_interval(bounds):
    values = np.random.default_rng(1).beta(1, 9, size=(5, 500))
    inner, outer = printed(values, bounds), both_scales(values, bounds)
    assert (outer[0] <= inner[0]).all()
    assert (outer[1] >= inner[1]).all()


def test_both_scales_stay_within_the_bounds():
    values = np.random.default_rng(1).beta(0.2, 0.4, size=(3, 500))
    low, high = both_scales(values, SHARE)
    assert low.min() >= 0.0
    assert high.max() <= 1.0


@pytest.mark.parametrize("value", [0.0, 0.3, 1.0])
def test_equal_values_give_both_scales_no_width(value):
    low, high = both_scales(np.full((4, 1), value), SHARE)
    assert (low[0], high[0]) == pytest.approx((value, value))


def test_both_scales_treat_a_difference_and_its_opposite_alike():
    values = np.random.default_rng(1).uniform(-0.2, 0.6, size=(5, 20))
    np.testing.assert_allclose(
        both_scales(values, DIFFERENCE), -both_scales(-values, DIFFERENCE)[::-1]
    )


def test_pairing_that_helps_earns_no_credit_and_pairing_that_harms_is_kept():
    first = np.array([[0.4], [0.5], [0.6]])
    alike, opposed = first - 0.1, first[::-1] - 0.1
    independent = 0.1 + np.array([-1, 1]) * 4.302653 * (2 * 0.1**2 / 3) ** 0.5
    np.testing.assert_allclose(unpaired_too(first, alike, DIFFERENCE)[:, 0], independent)
    expected = printed(first - opposed, DIFFERENCE)
    np.testing.assert_allclose(unpaired_too(first, opposed, DIFFERENCE), expected)


def test_the_guaranteed_interval_moves_a_mass_of_epsilon_to_the_bounds():
    # Four values: the lowest ε of the mass goes to 1, the highest to 0.
    moved = float(ksone.ppf(0.975, 4))
    assert 0.5 < moved < 0.75
    low, high = guaranteed(np.array([[0.1], [0.2], [0.3], [0.4]]), SHARE)
    left = 1 - moved - 0.25  # Of the second value from the kept end.
    assert low[0] == pytest.approx(0.25 * 0.1 + left * 0.2)
    assert high[0] == pytest.approx(moved + 0.25 * 0.4 + left * 0.3)


def test_only_the_guaranteed_interval_covers_what_seldom_is_found():
    law = rare(0.1)
    values = law.sample(np.random.default_rng(0), (5, 4000))
    covers = {
        name: cover_of(ends(values, SHARE), law.mean).cover for name, ends in INTERVALS.items()
    }
    assert covers["guaranteed"] >= 0.95
    assert covers["t, as printed"] < 0.6
    assert covers["t, both scales"] < 0.6

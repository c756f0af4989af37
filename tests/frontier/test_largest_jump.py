"""Placement of λ: hand-computed jumps, ties, fallbacks, later rounds and the texts of errors."""

from __future__ import annotations

import inspect
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid.frontier.largest_jump import (
    LambdaInterval,
    first_lambdas,
    largest_jump,
    next_lambdas,
)

PAPER_GRID = (1e-5, 1.58489e-4, 2.51189e-3, 3.98107e-2, 0.630957, 10.0)
"""The six λ of the paper's first round: 1e-5 to 10, even in log (App. D)."""

STEP = [0.02, 0.03, 0.05, 0.61, 0.90, 0.97]
NOISY = [0.05, 0.20, 0.10, 0.55, 0.45, 0.95]
UNSORTED = [10, 1e-5, 0.1, 1e-3, 0.02, 0.004]
OF_UNSORTED = [0.96, 0.01, 0.70, 0.06, 0.30, 0.65]
TIES = [0, 0.5, 0.5, 1, 1, 1]
TWO_JUMPS = [0, 0.4, 0.4, 0.4, 0.4, 0.4, 0.8]
FALLING = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4]

naturalness_values = st.floats(0.0, 1.0)
rounds = st.lists(
    st.tuples(st.integers(-30, 30).map(lambda power: 2.0**power), naturalness_values),
    min_size=2,
    max_size=12,
    unique_by=lambda pair: pair[0],
)
windows = st.integers(2, 5)


@pytest.mark.parametrize(
    ("lambdas", "naturalness", "window", "expected"),
    [
        pytest.param(PAPER_GRID, STEP, 2, (2.51189e-3, 0.630957), id="step-window-2"),
        pytest.param(PAPER_GRID, STEP, 3, (1.58489e-4, 10), id="step-window-3"),
        pytest.param(PAPER_GRID, STEP, 6, (1e-5, 10), id="step-window-of-all"),
        pytest.param(PAPER_GRID, STEP, 9, (1e-5, 10), id="step-window-beyond-all"),
        pytest.param(PAPER_GRID, NOISY, 2, (0.630957, 10), id="noisy-window-2"),
        pytest.param(PAPER_GRID, NOISY, 3, (2.51189e-3, 10), id="noisy-window-3"),
        pytest.param(UNSORTED, OF_UNSORTED, 2, (0.02, 10), id="unsorted-window-2"),
        pytest.param(UNSORTED, OF_UNSORTED, 3, (1e-3, 10), id="unsorted-window-3"),
        pytest.param(PAPER_GRID, TIES, 2, (2.51189e-3, 3.98107e-2), id="ties-window-2"),
        pytest.param(PAPER_GRID, TIES, 3, (1e-5, 3.98107e-2), id="ties-window-3"),
        pytest.param(range(1, 8), TWO_JUMPS, 2, (6, 7), id="two-jumps-window-2"),
        pytest.param(range(1, 8), TWO_JUMPS, 3, (5, 7), id="two-jumps-window-3"),
    ],
)
def test_jump_computed_by_hand(lambdas, naturalness, window, expected):
    assert largest_jump(np.array(lambdas), np.array(naturalness), window=window) == expected


def test_window_is_two_unless_said_otherwise():
    assert largest_jump(PAPER_GRID, STEP) == largest_jump(PAPER_GRID, STEP, window=2)
    assert largest_jump(PAPER_GRID, STEP) != largest_jump(PAPER_GRID, STEP, window=3)


@pytest.mark.parametrize("window", [2, 3])
@pytest.mark.parametrize("naturalness", [FALLING, [0.2] * 6], ids=["falling", "flat"])
def test_where_nothing_rises_the_widest_log_gap_is_searched(naturalness, window):
    lambdas = [1e-3, 1e-2, 0.03, 1.0, 3.0, 9.0]  # In λ itself the widest gap would be (3, 9).
    assert largest_jump(lambdas, naturalness, window) == (0.03, 1.0)


@pytest.mark.parametrize("window", [2, 3])
def test_of_equally_wide_gaps_the_one_at_the_larger_lambda_is_searched(window):
    lambdas = np.geomspace(1e-5, 10, 6)  # Equal in log up to rounding.
    assert np.ptp(np.diff(np.log(lambdas))) > 0.0
    assert largest_jump(lambdas, FALLING, window) == (lambdas[4], lambdas[5])


def test_rises_that_differ_by_rounding_are_a_tie():
    naturalness = np.linspace(0.0, 1.0, 6)  # Every inner rise is .4, but for the last bits.
    assert largest_jump([1, 2, 3, 4, 5, 6], naturalness) == (4, 6)


def test_a_rise_of_rounding_error_alone_is_no_rise():
    assert largest_jump([1.0, 2.0, 8.0, 16.0], [0.3, 0.3, 0.3, 0.1 + 0.2]) == (2.0, 8.0)


@given(points=rounds, window=windows, data=st.data())
def test_order_of_the_points_is_irrelevant(points, window, data):
    shuffled = data.draw(st.permutations(points))
    assert largest_jump(*zip(*shuffled, strict=True), window=window) == largest_jump(
        *zip(*points, strict=True), window=window
    )


@given(points=rounds, window=windows)
def test_interval_is_ascending_and_ends_at_trained_lambdas(points, window):
    lambdas = [lambda_ for lambda_, _ in points]
    interval = largest_jump(*zip(*points, strict=True), window=window)
    assert interval.lower < interval.upper
    assert set(interval) <= set(lambdas)


@given(points=rounds, window=windows)
def test_interval_spans_at_most_two_windows(points, window):
    """Low lies up to L - 1 points below i and high up to L - 1 above it."""
    lambdas = sorted(lambda_ for lambda_, _ in points)
    lower, upper = largest_jump(*zip(*points, strict=True), window=window)
    assert lambdas.index(upper) - lambdas.index(lower) <= 2 * (window - 1)


@given(points=rounds)
def test_a_window_over_all_points_finds_the_largest_rise_there_is(points):
    naturalness = dict(points)
    lambdas = sorted(naturalness)
    rises = [
        naturalness[high] - naturalness[low]
        for position, low in enumerate(lambdas)
        for high in lambdas[position + 1 :]
    ]
    lower, upper = largest_jump(*zip(*points, strict=True), window=len(points))
    if max(rises) > 1e-9:
        assert naturalness[upper] - naturalness[lower] == pytest.approx(max(rises), abs=1e-8)


@pytest.mark.parametrize(
    ("lambdas", "naturalness", "window", "message"),
    [
        ([0.0, 1.0], [0.1, 0.2], 2, r"lambdas must be finite and > 0.*, got 0\.0"),
        ([-2.0, 1.0], [0.1, 0.2], 2, r"lambdas must be finite and > 0.*, got -2\.0"),
        ([1.0, math.inf], [0.1, 0.2], 2, "lambdas must be finite and > 0.*, got inf"),
        ([1.0, math.nan], [0.1, 0.2], 2, "lambdas must be finite and > 0.*, got nan"),
        ([1.0, 0.5, 1.0], [0.1, 0.2, 0.3], 2, r"distinct, got 1\.0 more than once"),
        ([1.0], [0.1], 2, r"lambdas must be at least 2 values in one row, got shape \(1,\)"),
        ([[1.0, 2.0]], [[0.1, 0.2]], 2, r"in one row, got shape \(1, 2\)"),
        ([1.0, 2.0], [0.1], 2, r"one value per λ, got shape \(1,\) for 2 λ"),
        ([1.0, 2.0], [0.1, 1.2], 2, r"naturalness must lie in \[0, 1\], got 1\.2"),
        ([1.0, 2.0], [-0.1, 0.2], 2, r"naturalness must lie in \[0, 1\], got -0\.1"),
        ([1.0, 2.0], [0.1, math.nan], 2, r"naturalness must lie in \[0, 1\], got nan"),
        ([1.0, 2.0], [0.1, 0.2], 1, "window must be at least 2 points, got 1"),
    ],
)
def test_malformed_points_are_refused_by_name_and_value(lambdas, naturalness, window, message):
    as_users_call_it = inspect.unwrap(largest_jump)  # The suite checks shapes before we can.
    with pytest.raises(ValueError, match=message):
        as_users_call_it(np.array(lambdas), np.array(naturalness), window)


def test_first_round_of_the_paper_spans_both_ends_evenly_in_log():
    lambdas = first_lambdas(1e-5, 10.0, 6)
    assert lambdas == pytest.approx(PAPER_GRID, rel=1e-5)
    assert (lambdas[0], lambdas[-1]) == (1e-5, 10.0)


@pytest.mark.parametrize(
    ("lower", "upper", "count", "message"),
    [
        (0.0, 1.0, 6, r"0 < lower < upper < ∞: 0\.0, 1\.0"),
        (2.0, 1.0, 6, r"0 < lower < upper < ∞: 2\.0, 1\.0"),
        (1.0, 1.0, 6, r"0 < lower < upper < ∞: 1\.0, 1\.0"),
        (1.0, math.inf, 6, r"0 < lower < upper < ∞: 1\.0, inf"),
        (0.1, 1.0, 1, "count must be at least 2 to include both ends, got 1"),
    ],
)
def test_malformed_first_round_is_refused(lower, upper, count, message):
    with pytest.raises(ValueError, match=message):
        first_lambdas(lower, upper, count)


def test_later_rounds_are_even_in_log_and_leave_out_the_trained_ends():
    lambdas = next_lambdas([1e-4, 10.0], (1e-4, 10.0), 4)
    assert lambdas == pytest.approx([1e-3, 1e-2, 1e-1, 1.0])


@pytest.mark.parametrize(
    ("trained", "count", "expected"),
    [
        pytest.param([1e-4, 1e-2, 1.0], 1, [1e-1], id="tie-goes-to-the-larger-lambda"),
        pytest.param([1e-4, 1e-3, 1e-2, 1.0], 1, [1e-1], id="widest-of-the-trained"),
        pytest.param([1e-4, 1e-2, 1e-1, 1.0], 1, [1e-3], id="widest-below"),
        pytest.param([1e-4, 1e-2 * (1 + 5e-10), 1.0], 1, [1e-1], id="equal-within-1e-9"),
        pytest.param([1e-4, 1e-2 * (1 + 5e-9), 1.0], 1, [1e-2], id="distinct-beyond-1e-9"),
        pytest.param([1e-4, 1e-2, 1.0], 3, [1e-3, 1e-1, 10**-0.5], id="gaps-between-placed-count"),
        pytest.param(
            [1e-4, 1e-3, 1e-2, 1.0], 3, [1e-1, 10**-1.5, 10**-0.5], id="two-moves-share-no-gap"
        ),
        pytest.param(
            [0.0, 1e-9, 1e-4, 1e-2, 1.0, 1e6, math.inf], 1, [1e-1], id="others-do-not-matter"
        ),
        pytest.param([1e-6, 10.0, 1e-2], 1, [1e-1], id="untrained-ends-still-bound-the-gaps"),
    ],
)
def test_a_lambda_trained_before_moves_to_the_middle_of_the_widest_gap(trained, count, expected):
    assert next_lambdas(trained, (1e-4, 1.0), count) == pytest.approx(sorted(expected))


@given(
    trained=st.lists(st.sampled_from(np.geomspace(1e-4, 1.0, 13).tolist()), max_size=12),
    count=st.integers(1, 8),
)
def test_new_lambdas_are_inside_ascending_and_never_trained(trained, count):
    lambdas = next_lambdas(trained, (1e-4, 1.0), count)
    assert len(lambdas) == count
    ends_and_new = [1e-4, *lambdas, 1.0]
    assert all(np.diff(np.log(ends_and_new)) > 1e-9)
    assert not any(math.isclose(new, old, rel_tol=1e-9) for new in lambdas for old in trained)


def test_three_rounds_as_in_the_paper_train_eighteen_distinct_lambdas():
    """App. D: six λ per round, three rounds; here a human who turns natural around λ = 0.03."""
    trained = first_lambdas(1e-5, 10.0, 6)
    for _ in range(2):
        naturalness = [1 / (1 + (0.03 / lambda_) ** 2) for lambda_ in trained]
        trained += next_lambdas(trained, largest_jump(trained, naturalness), 6)
    assert len(trained) == len(set(trained)) == 18
    assert sum(0.003 <= lambda_ <= 0.3 for lambda_ in trained) >= 9


@pytest.mark.parametrize(
    ("trained", "interval", "count", "message"),
    [
        ([1.0], (1.0, 1.0), 3, r"0 < lower < upper < ∞: 1\.0, 1\.0"),
        ([1.0], (0.0, 1.0), 3, r"0 < lower < upper < ∞: 0\.0, 1\.0"),
        ([1.0], (0.1, 1.0), 0, "count must be at least 1, got 0"),
        ([math.nan], (0.1, 1.0), 3, r"trained must not contain NaN, got \[nan\]"),
        ([1.0], (1.0, 1.0 + 1e-10), 1, r"no room for another λ, widest gap: \(1\.0, 1\.00"),
    ],
)
def test_malformed_later_round_is_refused(trained, interval, count, message):
    with pytest.raises(ValueError, match=message):
        next_lambdas(trained, interval, count)


def test_interval_has_named_ends():
    assert LambdaInterval(lower=0.1, upper=1.0) == (0.1, 1.0)

"""Pairs of measurements, and their spread beside the one that seeds predict."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.reliability.plan import NUMBERS
from benchmarks.reliability.spread import measurement_rows, pair_rows, share_within, spread_of
from rigid.frontier.comparison import Number, repeat_spread
from rigid.frontier.intervals import t_interval


def number(*values):
    return Number({str(seed): value for seed, value in enumerate(values)})


def measured(*means):
    """Measurements whose every number has this mean, with seeds 0.1 to either side."""
    return [dict.fromkeys(NUMBERS, number(mean - 0.1, mean + 0.1)) for mean in means]


def test_every_pair_comes_once_for_each_number():
    rows = pair_rows(measured(*(0.1 * n for n in range(1, 7))))
    pairs = [(row["first"], row["second"]) for row in rows if row["number"] == "auc"]
    assert len(pairs) == len(set(pairs)) == 15
    assert all(first < second for first, second in pairs)
    assert len(rows) == 15 * len(NUMBERS)


def test_a_difference_is_the_second_minus_the_first():
    (row,) = [row for row in pair_rows(measured(0.5, 0.42)) if row["number"] == "auc"]
    assert row["difference"] == pytest.approx(-0.08)


def test_limits_hold_for_sizes_of_differences():
    rows = pair_rows(measured(0.50, 0.45, 0.51))  # -.05, +.01, +.06
    assert share_within(rows, "auc") == pytest.approx(1 / 3)
    assert share_within(rows, "worst_at") == pytest.approx(2 / 3)
    unlimited = [row["within_limit"] for row in rows if row["number"] == "auc_natural"]
    assert unlimited == [None] * 3


def test_a_pair_holds_what_compare_would_print_for_each():
    one, other = number(0.4, 0.5, 0.6), number(0.1, 0.5, 0.9)
    rows = pair_rows([dict.fromkeys(NUMBERS, one), dict.fromkeys(NUMBERS, other)])
    assert rows[0]["printed_by_first"] == repeat_spread(one)
    assert rows[0]["printed_by_second"] == repeat_spread(other)


def test_a_measurement_has_its_interval_and_deviation():
    row = measurement_rows([dict.fromkeys(NUMBERS, number(0.4, 0.5, 0.6))])[0]
    assert (row["low"], row["high"]) == t_interval([0.4, 0.5, 0.6])
    assert row["deviation_over_seeds"] == pytest.approx(0.1)
    assert row["seeds"] == "0 1 2"


def test_equal_seeds_predict_nothing():
    found = spread_of([number(0.4, 0.4), number(0.6, 0.6)])
    assert (found.predicted, found.ratio, found.low, found.high) == (0.0, None, None, None)
    assert found.added == pytest.approx(found.measured)
    assert found.held == 0.0


def test_a_repeat_is_held_against_what_the_first_of_each_order_printed():
    wide, narrow = number(0.3, 0.7), number(0.699, 0.701)  # Means .5 and .7.
    found = spread_of([wide, narrow])
    assert repeat_spread(wide) > 0.2 > repeat_spread(narrow)
    assert found.held == 0.5


def spreads(*, added, count=400, measurements=6, seeds=8):
    """Of `count` studies with normal values, where measurements differ by `added` beyond seeds."""
    rng = np.random.default_rng(4)
    for _ in range(count):
        moved = rng.normal(0, added, size=(measurements, 1))
        yield spread_of([number(*row) for row in 0.5 + moved + rng.normal(0, 0.1, (6, seeds))])


def test_where_only_seeds_differ_the_ratio_is_1_in_95_percent_of_its_intervals():
    found = list(spreads(added=0.0))
    covered = np.mean([one.low <= 1 <= one.high for one in found])
    assert covered == pytest.approx(0.95, abs=0.03)
    assert np.mean([one.held for one in found]) == pytest.approx(0.95, abs=0.02)


def test_what_measurements_add_beyond_their_seeds_is_found():
    found = list(spreads(added=0.1))
    assert np.sqrt(np.mean([one.added**2 for one in found])) == pytest.approx(0.1, abs=0.01)
    assert np.mean([one.low > 1 for one in found]) > 0.8


def test_seeds_are_listed_as_numbers_and_not_as_words():
    seen = Number({"10": 0.5, "9": 0.4})
    assert measurement_rows([dict.fromkeys(NUMBERS, seen)])[0]["seeds"] == "9 10"

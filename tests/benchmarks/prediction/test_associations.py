"""Correlations and their differences, of robots whose order is known."""

from __future__ import annotations

import pytest

from benchmarks.prediction.associations import correlation_rows, difference_rows, find
from tests.benchmarks.prediction.samples import HUMANS, subject

FAILURES = (0.1, 0.2, 0.3, 0.4, 0.5)
MAIN = {"robots": "all", "humans": "all", "target": "adversarialness"}


def robots(headlines, **options):
    return [
        subject(place, headline, failure, **options)
        for place, (headline, failure) in enumerate(zip(headlines, FAILURES, strict=True))
    ]


def correlations(subjects):
    return correlation_rows(subjects, HUMANS, resamples=50)


def test_a_headline_in_the_order_of_failures_has_tau_1():
    row = find(correlations(robots(FAILURES)), **MAIN, predictor="worst_at_0.9")
    assert (row["n"], row["tau"], row["rho"]) == (5, 1.0, 1.0)
    assert row["tau_p"] == pytest.approx(2 / 120)


def test_a_headline_in_the_opposite_order_has_tau_minus_1():
    row = find(correlations(robots(FAILURES[::-1])), **MAIN, predictor="worst_at_0.9")
    assert (row["tau"], row["rho"]) == (-1.0, -1.0)


def test_a_number_that_no_two_robots_differ_in_has_no_correlation():
    row = find(correlations(robots(FAILURES)), **MAIN, predictor="canonical")
    assert (row["tau"], row["tau_low"], row["tau_p"], row["rho"]) == (None, None, None, None)


def test_seeds_that_agree_leave_the_robots_alone_in_the_interval():
    row = find(correlations(robots((0.2, 0.1, 0.4, 0.3, 0.5))), **MAIN, predictor="worst_at_0.9")
    assert row["tau_seeds_low"] == row["tau_seeds_high"] == row["tau"] == pytest.approx(0.6)
    assert (row["tau_low"], row["tau_high"]) == (row["tau_robots_low"], row["tau_robots_high"])


def test_three_robots_are_too_few():
    row = find(correlations(robots(FAILURES)[:3]), **MAIN, predictor="worst_at_0.9")
    assert (row["n"], row["tau"], row["tau_p"]) == (3, None, None)


def test_robots_that_fail_their_own_human_are_not_competent():
    subjects = [*robots(FAILURES), subject(9, 0.9, 0.9, success=0.94)]
    rows = correlations(subjects)
    counts = {
        row["robots"]: row["n"]
        for row in rows if row["predictor"] == "auc" and row["humans"] == "all"
    }  # fmt: skip
    assert counts == {"all": 6, "competent": 5}


def test_no_robot_may_be_competent():
    row = find(
        correlations(robots(FAILURES, success=0.1)),
        **{**MAIN, "robots": "competent"}, predictor="auc",
    )  # fmt: skip
    assert (row["n"], row["tau"]) == (0, None)


def test_the_baseline_adds_nothing_to_itself():
    row = find(correlations(robots(FAILURES)), **MAIN, predictor="canonical")
    assert row["tau_partial"] is None


def test_a_number_that_orders_robots_beats_one_that_reverses_them():
    subjects = [
        subject(place, failure + 0.5, failure, canonical=0.5 - failure)
        for place, failure in enumerate(FAILURES)
    ]
    rows = difference_rows(subjects, HUMANS, resamples=50)
    row = find(rows, **MAIN, first="worst_at_0.9", second="canonical")
    assert (row["tau_difference"], row["tau_difference_low"]) == (2.0, 2.0)


def test_rows_have_equal_columns_whatever_is_unknown():
    rows = correlations([*robots(FAILURES, success=0.9)])
    assert len({tuple(row) for row in rows}) == 1

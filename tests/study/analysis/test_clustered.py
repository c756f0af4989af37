"""Means of judgements in which raters and pairs come again and again."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.frontier.crossed import crossed_interval
from rigid.study.analysis.clustered import clustered_mean


def table(raters=8, pairs=12, *, by_rater=0.6, by_pair=0.4, seed=0):
    rng = np.random.default_rng(seed)
    values = 3 + by_rater * rng.normal(size=(raters, 1)) + by_pair * rng.normal(size=(1, pairs))
    rows, columns = np.meshgrid(np.arange(raters), np.arange(pairs), indexing="ij")
    return values + 0.5 * rng.normal(size=(raters, pairs)), rows, columns


def test_a_whole_table_has_the_interval_of_the_crossed_layout():
    values, raters, pairs = table()
    found = clustered_mean(values.ravel(), raters.ravel(), pairs.ravel())
    expected = crossed_interval(values, bounds=(-np.inf, np.inf))
    np.testing.assert_allclose(found.interval(0.95, (-np.inf, np.inf)), expected, rtol=1e-9)


def test_where_raters_differ_more_answers_do_not_narrow_the_interval():
    few, many = (table(8, pairs, by_rater=2.0, by_pair=0.0) for pairs in (10, 200))
    few, many = (clustered_mean(*(a.ravel() for a in one)).se for one in (few, many))
    assert many > 0.7 * few


def test_answers_that_are_independent_have_their_plain_error_at_least():
    rng = np.random.default_rng(1)
    values, raters, pairs = rng.normal(size=200), np.repeat(np.arange(20), 10), np.arange(200) % 10
    assert clustered_mean(values, raters, pairs).se >= values.std(ddof=1) / 200**0.5 - 1e-12


def test_a_table_with_gaps_has_an_interval_too():
    values, raters, pairs = (a.ravel() for a in table())
    kept = np.random.default_rng(2).uniform(size=len(values)) < 0.6
    found = clustered_mean(values[kept], raters[kept], pairs[kept])
    assert (found.raters, found.pairs, found.answers) == (8, 12, kept.sum())
    assert 0 < found.se < 1


@pytest.mark.parametrize("lone", ["rater", "pair"])
def test_one_rater_or_one_pair_says_nothing_of_others(lone):
    values, raters, pairs = (a.ravel() for a in table())
    one = raters == 0 if lone == "rater" else pairs == 0
    found = clustered_mean(values[one], raters[one], pairs[one])
    assert found.se is None
    assert found.interval(0.95, (0.0, 7.0)) is None


def test_raters_who_saw_pairs_of_their_own_are_the_units():
    values, raters, _ = (a.ravel() for a in table())
    found = clustered_mean(values, raters, np.arange(len(values)))
    by_rater = np.array([values[raters == rater].mean() for rater in range(8)])
    assert found.se == pytest.approx(by_rater.std(ddof=1) / 8**0.5)
    assert found.freedom == 7


def test_no_answers_are_refused():
    nobody = np.zeros(0, dtype=int)
    with pytest.raises(ValueError, match="at least one"):
        clustered_mean(np.zeros(0), nobody, nobody)

"""Faithfulness: that there is no preference is claimed by a test, not by the lack of one."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.study.analysis.equivalence import equivalence
from rigid.study.analysis.judged import choices_of
from tests.study.analysis.scripted_answers import SHARE, chosen, halves


def result(answers, margin=0.1):
    second, rater, pair, _ = choices_of(answers)
    return equivalence(second, rater, pair, margin=margin)


def balanced(raters, pairs):
    """Everybody chooses either one equally often, and either is chosen of every pair as often."""
    table = np.add.outer(np.arange(raters), np.arange(pairs)) % 2 == 0
    return chosen(table, np.random.default_rng(0))


@pytest.mark.parametrize("seed", range(3))
def test_half_of_the_raters_who_prefer_with_0_8_are_recovered(seed):
    found = result(halves(seed=seed))
    assert found.interval.low <= SHARE <= found.interval.high
    assert found.p_equivalence > 0.4


def test_enough_of_them_are_told_from_no_preference():
    found = result(halves(60, 40))
    assert found.interval.low <= SHARE <= found.interval.high
    assert found.verdict == "different"
    assert found.p_difference < 0.001


def test_raters_without_preference_are_equivalent_once_they_are_enough():
    assert result(balanced(16, 30)).verdict == "equivalent"
    assert result(balanced(4, 6)).verdict == "undecided"


def test_a_smaller_margin_is_harder_to_stay_within():
    answers = balanced(16, 30)
    wide, narrow = (result(answers, margin=margin).p_equivalence for margin in (0.2, 0.02))
    assert wide < 0.001
    assert narrow > 0.1


def test_the_test_says_equivalent_exactly_where_its_interval_lies_within_the_margin():
    for seed in range(12):
        rng = np.random.default_rng(seed)
        found = result(chosen(rng.uniform(size=(10, 30)) < 0.55, rng))
        low, high = found.interval_of_test
        assert (found.verdict == "equivalent") == (low > 0.4 and high < 0.6)


def test_raters_who_all_always_choose_the_same_are_different():
    found = result(chosen(np.ones((4, 6), dtype=bool), np.random.default_rng(0)))
    assert (found.verdict, found.p_equivalence, found.share.mean) == ("different", 1.0, 1.0)


def test_one_rater_alone_leaves_it_unknown():
    found = result(balanced(1, 30))
    assert (found.verdict, found.p_equivalence, found.interval) == ("unknown", None, None)


def test_a_rater_whose_answers_are_not_independent_does_not_count_thirty_times():
    """Four raters of firm and opposite taste show nothing of raters at large."""
    table = np.repeat(np.arange(4) % 2 == 0, 30).reshape(4, 30)
    found = result(chosen(table, np.random.default_rng(0)))
    assert found.share.mean == 0.5
    assert found.verdict == "undecided"

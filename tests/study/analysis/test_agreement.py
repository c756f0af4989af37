"""Krippendorff's alpha with an interval over pairs."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.study.analysis.agreement import agreement
from rigid.study.analysis.judged import choices_of
from tests.study.analysis.scripted_answers import ALPHA, agreeing, halves


def of_choices(answers):
    second, rater, pair, _ = choices_of(answers)
    return agreement(second, rater, pair, pair, scale="nominal")


@pytest.mark.parametrize("accuracy", [0.7, 0.8, 0.95])
def test_raters_who_find_the_right_answer_with_q_agree_as_two_q_minus_one_squared(accuracy):
    found = of_choices(agreeing(accuracy=accuracy))
    assert found.interval.low <= (2 * accuracy - 1) ** 2 <= found.interval.high
    assert (found.raters, found.pairs) == (10, 60)


def test_preferences_that_no_pair_shares_are_no_agreement():
    found = of_choices(halves())
    assert found.interval.low <= ALPHA <= found.interval.high
    assert abs(found.alpha) < 0.05


def test_raters_who_always_agree_have_alpha_1():
    found = of_choices(agreeing(accuracy=1.0))
    assert (found.alpha, *found.interval) == (1.0, 1.0, 1.0)


def test_scores_that_lie_near_each_other_agree_more_than_scores_that_lie_apart():
    raters, pairs = np.repeat([0, 1], 8), np.tile(np.arange(8), 2)
    near, far = np.arange(8) ^ 1, 7 - np.arange(8)

    def alpha(other):
        values = np.concatenate([np.arange(8), other]).astype(float)
        return agreement(values, raters, pairs, pairs, scale="ordinal").alpha

    assert alpha(near) > 0.8
    assert alpha(far) < 0


def test_where_everybody_gives_one_answer_agreement_is_undefined():
    ones = np.ones(20)
    raters, pairs = np.repeat([0, 1], 10), np.tile(np.arange(10), 2)
    found = agreement(ones, raters, pairs, pairs, scale="nominal")
    assert (found.alpha, found.interval) == (None, None)


def test_one_rater_agrees_with_nobody():
    assert of_choices(agreeing(raters=1)).alpha is None


def test_few_pairs_have_no_interval():
    found = of_choices(agreeing(pairs=4))
    assert found.alpha is not None
    assert found.interval is None

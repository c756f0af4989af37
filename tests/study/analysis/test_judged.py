"""Answers as arrays."""

from __future__ import annotations

import numpy as np

from rigid.study.analysis.attention import Attention, attention, who_failed
from rigid.study.analysis.judged import choices_of, differences_of, scores_of
from tests.study.analysis.scripted_answers import answer, check, made_pairs


def test_danger_is_the_second_question_minus_the_first():
    both = [answer(0, 0, 6, "danger", "first"), answer(0, 0, 2, "goal", "first")]
    (score,) = scores_of(both, "danger", made_pairs(1)).score
    assert score == 4


def test_a_member_with_half_an_answer_has_no_score():
    assert not len(scores_of([answer(0, 0, 6, "danger", "first")], "danger", made_pairs(1)).score)


def test_scores_stand_where_their_member_lies():
    pairs = made_pairs(3, kind="naturalness")
    given = [answer(0, 2, 5, "naturalness", "second"), answer(1, 1, 3, "naturalness", "first")]
    found = scores_of(given, "naturalness", pairs)
    assert found.naturalness.tolist() == [pairs[2].second.naturalness, pairs[1].first.naturalness]
    assert found.adversarialness[0] == pairs[2].second.adversarialness
    assert found.member.tolist() == [5, 2]


def test_differences_are_of_raters_who_judged_both():
    given = [
        answer(0, 0, 5, "naturalness", "second"), answer(0, 0, 2, "naturalness", "first"),
        answer(1, 0, 7, "naturalness", "second"),
    ]  # fmt: skip
    apart, rater, pair = differences_of(scores_of(given, "naturalness", made_pairs(1)))
    assert (apart.tolist(), rater.tolist(), pair.tolist()) == ([3.0], [0], [0])


def test_attention_checks_are_no_answers():
    found = choices_of([answer(0, 0, 1), check(0, passed=True)])
    assert found.chose_second.tolist() == [1.0]


def test_the_left_one_was_chosen_whichever_that_was():
    given = [
        answer(0, 0, 1, shown_left="second"), answer(0, 1, 1, shown_left="first"),
        answer(0, 2, 0, shown_left="first"),
    ]  # fmt: skip
    np.testing.assert_array_equal(choices_of(given).chose_left, [1, 0, 1])


def test_who_fails_one_check_has_failed():
    given = [check(0, passed=True), check(1, passed=True)]
    given.append(answer(1, None, 0, trial="t98", passed=False))
    found = attention(given)
    assert found == [Attention("S00", 1, 0), Attention("S01", 2, 1)]
    assert who_failed(found) == {"S01"}


def test_a_check_of_several_scales_is_one_check():
    scales = [
        answer(0, None, 7, question, passed=passed)
        for question, passed in (("goal", True), ("danger", False))
    ]
    assert attention(scales) == [Attention("S00", 1, 1)]

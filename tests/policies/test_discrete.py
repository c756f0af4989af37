"""Answers of other libraries as actions: scores for choices, reals, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.policies.discrete import actions_of, scores_of, taken
from rigid.tasks.protocol import AgentSpec

REALS, CHOICES = AgentSpec(3, 2), AgentSpec(3, 5, choices=(3, 2))


def test_choices_side_by_side_have_their_scores_side_by_side():
    found = scores_of(np.array([[2, 0], [1, 1]]), (3, 2))
    np.testing.assert_array_equal(found, [[-1, -1, 1, 1, -1], [-1, 1, -1, -1, 1]])


def test_the_task_takes_back_what_was_chosen():
    chosen = np.array([3, 0, 2])
    np.testing.assert_array_equal(scores_of(chosen, (4,)).argmax(axis=1), chosen)


@pytest.mark.parametrize(
    ("chosen", "choices", "message"),
    [
        ([[0, 2]], (3, 2), "chooses 2, but the choices are 0 to 1"),
        ([[-1, 0]], (3, 2), "chooses -1, but the choices are 0 to 2"),
        ([0, 1], (3, 2), "chooses \\(2,\\) numbers, but there are 2 discrete actions, of 3 and 2"),
        ([[[0]]], (3,), "chooses \\(1, 1, 1\\) numbers"),
    ],
)
def test_a_choice_that_there_is_not_is_refused(chosen, choices, message):
    with pytest.raises(ValueError, match=message):
        scores_of(np.array(chosen), choices)


def test_reals_are_clipped_to_what_tasks_take():
    found = actions_of(np.array([[2.0, -3.0], [0.5, 0.0]], np.float32), REALS, 2)
    np.testing.assert_array_equal(found, [[1.0, -1.0], [0.5, 0.0]])
    assert found.dtype == np.float64


def test_a_single_real_may_come_without_its_axis():
    found = actions_of(np.array([0.5, -0.5]), AgentSpec(3, 1), 2)
    np.testing.assert_array_equal(found, [[0.5], [-0.5]])


def test_whole_numbers_become_scores():
    np.testing.assert_array_equal(
        actions_of(np.array([[1, 0]], np.int32), CHOICES, 1), [[-1, 1, -1, 1, -1]]
    )


def test_the_largest_score_is_chosen_before_anything_is_clipped():
    scores = np.array([[1.5, 2.5, -0.3, -3.0, -2.0]])
    np.testing.assert_array_equal(actions_of(scores, CHOICES, 1), [[-1, 1, -1, -1, 1]])
    np.testing.assert_array_equal(taken(scores[None], CHOICES), [[[-1, 1, -1, -1, 1]]])


@pytest.mark.parametrize(
    ("answer", "spec", "message"),
    [
        (np.zeros((2, 3)), REALS, r"shape \(2, 3\), but the task takes \(2, 2\)$"),
        (np.zeros((3, 2)), REALS, r"shape \(3, 2\), but the task takes \(2, 2\)"),
        (np.zeros((2, 2)), CHOICES, r"takes \(2, 5\), or whole numbers for 3 and 2 choices"),
        (np.zeros((2, 2), int), REALS, "whole numbers, as for discrete actions, but the task"),
        (np.zeros((3, 2), int), CHOICES, r"\(3, 2\) choices for 2 worlds"),
        (np.array(1), CHOICES, r"\(\) choices for 2 worlds"),
        (np.array([[0, 0], [0, np.nan]]), REALS, "not finite, in world 1: \\[ 0. nan\\]"),
        (np.array(["a", "b"]), REALS, "answers <U1, but actions are numbers"),
    ],
)
def test_what_is_no_action_is_refused_with_both_shapes(answer, spec, message):
    with pytest.raises(ValueError, match=message):
        actions_of(answer, spec, 2)

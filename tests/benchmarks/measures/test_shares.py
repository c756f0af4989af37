"""What one set of points has that others have not, on cases worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.measures.shares import alone, exclusive_area

NOBODY = np.empty((0, 2))


def test_a_point_that_another_one_beats_on_both_axes_is_not_alone():
    mine = np.array([[0.4, 0.4], [0.4, 0.7]])
    assert alone(mine, np.array([[0.5, 0.5]])).tolist() == [False, True]


def test_equal_points_do_not_beat_each_other():
    same = np.array([[0.4, 0.4]])
    assert alone(same, same).tolist() == [True]


def test_with_a_margin_a_point_as_good_within_it_counts():
    mine, others = np.array([[0.4, 0.4]]), np.array([[0.36, 0.9]])
    assert alone(mine, others, margin=0.05).tolist() == [False]
    assert alone(mine, others, margin=0.03).tolist() == [True]


def test_a_margin_holds_on_each_axis():
    assert alone(np.array([[0.4, 0.4]]), np.array([[0.36, 0.3]]), margin=0.05).tolist() == [True]


def test_everything_is_alone_where_nobody_else_is():
    assert alone(np.array([[0.1, 0.1]]), NOBODY).tolist() == [True]


def test_the_exclusive_area_is_what_the_hull_loses():
    found = {
        "a": np.array([[0.0, 1.0]]),
        "b": np.array([[0.5, 1.0]]),  # Hull with it: a square and a triangle, .75.
        "c": np.array([[0.5, 0.2]]),
    }
    assert exclusive_area(found, "b", 0.0) == pytest.approx(0.25)
    assert exclusive_area(found, "a", 0.0) == pytest.approx(0.0)
    assert exclusive_area(found, "c", 0.0) == pytest.approx(0.0)


def test_what_two_of_them_found_is_exclusive_to_neither():
    both = np.array([[0.5, 1.0]])
    assert exclusive_area({"a": both, "b": both}, "a", 0.0) == 0.0


def test_the_exclusive_area_of_the_only_one_lies_above_the_anchor():
    # Under (0.5, 1) and (1, 0.2): .5 + .3; under the anchor alone: .2.
    found = {"a": np.array([[0.5, 1.0]])}
    assert exclusive_area(found, "a", 0.2) == pytest.approx(0.6)


def test_a_search_whose_points_all_faulted_loses_nothing():
    found = {"a": NOBODY, "b": np.array([[0.5, 1.0]])}
    assert exclusive_area(found, "a", 0.0) == 0.0

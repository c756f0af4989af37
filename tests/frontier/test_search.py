"""Rounds of λ: the first spans the range, later ones refine where naturalness jumps most."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid.frontier.search import next_round

RANGE = {"lambda_min": 1e-5, "lambda_max": 10.0}


def test_the_first_round_spans_the_range_evenly_in_log():
    first = next_round([], [], per_round=(7, 2), **RANGE)
    assert (first[0], first[-1]) == pytest.approx((1e-5, 10.0))
    assert {round(high / low, 6) for low, high in pairwise(first)} == {10.0}


def test_a_later_round_lies_inside_the_largest_jump():
    first = next_round([], [], per_round=(7, 2), **RANGE)
    scores = [0.0, 0.0, 0.1, 0.1, 0.8, 0.9, 0.9]
    second = next_round([first], [scores], per_round=(7, 2), **RANGE)
    assert len(second) == 2
    assert first[3] < second[0] < second[1] < first[5]  # The lowest and highest of two windows.


def test_a_third_round_sees_the_points_of_both_before_it():
    rounds = {"per_round": (3, 1, 1), "lambda_min": 0.01, "lambda_max": 1.0}
    trained = [[0.01, 0.1, 1.0], [0.03]]
    (third,) = next_round(trained, [[0.0, 0.9, 0.9], [0.1]], **rounds)
    assert 0.03 < third < 1.0
    (third,) = next_round(trained, [[0.0, 0.9, 0.9], [0.85]], **rounds)
    assert 0.01 < third < 0.1


def test_the_search_is_over_after_its_rounds():
    assert next_round([[0.1, 1.0]], [[0.0, 1.0]], per_round=(2,), **RANGE) is None


@given(
    scores=st.lists(st.floats(0, 1), min_size=12, max_size=12),
    per_round=st.tuples(st.integers(2, 5), st.integers(1, 4), st.integers(1, 3)),
)
def test_no_lambda_is_trained_twice_and_none_leaves_the_range(scores, per_round):
    trained: list[list[float]] = []
    naturalness: list[list[float]] = []
    while (chosen := next_round(trained, naturalness, per_round=per_round, **RANGE)) is not None:
        trained.append(chosen)
        naturalness.append(scores[: len(chosen)])
        scores = scores[len(chosen) :]
    everything = [value for values in trained for value in values]
    assert [len(values) for values in trained] == list(per_round)
    assert len(set(everything)) == len(everything)
    assert 1e-5 * 0.999 <= min(everything) <= max(everything) <= 10.0 * 1.001

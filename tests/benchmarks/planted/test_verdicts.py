"""Verdicts of the planted study on humans that were judged by hand."""

from __future__ import annotations

import pytest

from benchmarks.planted.arena import Judgement
from benchmarks.planted.ceiling import area
from benchmarks.planted.verdicts import advantage, alarm, found


def human(naturalness, *, shown=0.0, missed=0.0, adversarialness=0.5):
    return Judgement(naturalness, adversarialness, shown, missed)


@pytest.mark.parametrize(
    ("naturalness", "shown", "expected"),
    [
        pytest.param(0.61, 0.5, True, id="half-of-the-episodes-within-the-margin"),
        pytest.param(0.59, 0.9, False, id="too-unnatural"),
        pytest.param(0.99, 0.49, False, id="too-rarely"),
    ],
)
def test_found_needs_half_of_the_episodes_and_nearly_the_true_naturalness(
    naturalness, shown, expected
):
    assert found([human(naturalness, shown=shown)], 0.7) is expected


def test_one_human_must_be_both_natural_and_show_the_weakness():
    assert not found([human(0.9, shown=0.1), human(0.1, shown=1.0)], 0.7)


def test_a_decoy_is_accused_by_a_natural_human_whom_it_misses_and_not_by_one_who_only_shows():
    assert alarm([human(0.7, missed=0.5)], 0.7)
    assert not alarm([human(0.7, shown=1.0, missed=0.4)], 0.7)


def test_the_advantage_is_the_mean_difference_of_shares_over_weaknesses():
    mine = {"a": [True, True], "b": [True, False], "c": [False, False]}
    theirs = {"a": [False, False], "b": [True, False], "c": [False, False]}
    mean, interval = advantage(mine, theirs)
    assert mean == pytest.approx(1 / 3)
    assert interval is not None
    assert interval.low < 0 < interval.high  # One of three.


def test_the_area_of_no_human_is_that_of_sabotage_mixed_with_canonical_play():
    assert area([], anchor=0.2) == pytest.approx(0.6)


def test_a_natural_and_harmful_human_adds_area():
    assert area([human(0.8, adversarialness=0.8)], anchor=0.2) > area([], anchor=0.2)

"""Robots in the order of their numbers, and of their failures with people."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.frontier.intervals import Interval
from rigid.study.analysis.order import order_test, people_difference, verdict

WORSE, BOTH = Interval(0.1, 0.3), Interval(-0.1, 0.3)


def difference(a, b):
    return people_difference(
        np.array(a, dtype=float), np.array(b, dtype=float), permutations=20_000,
        rng=np.random.default_rng(0),
    )  # fmt: skip


def test_eight_people_who_all_fail_more_with_one_robot_are_two_in_256():
    found = difference([0.0] * 8, [0.4] * 8)
    assert found.p == pytest.approx(2 / 256)
    assert found.mean == pytest.approx(0.4)


def test_people_who_fail_alike_tell_nothing():
    assert difference([0.2, 0.4, 0.6], [0.2, 0.4, 0.6]).p == 1.0


def test_pairing_by_person_sees_what_means_hide():
    """People differ by far more than robots do."""
    people = np.linspace(0, 0.9, 8)
    assert difference(people, people + 0.05).p < 0.01


def test_many_people_are_drawn_from_and_agree_with_going_through_all():
    rng = np.random.default_rng(3)
    a, b = rng.uniform(size=12), rng.uniform(size=12)
    exact = difference(a, b).p
    drawn = people_difference(a, b, permutations=4000, rng=rng).p
    assert drawn == pytest.approx(exact, abs=0.03)
    assert drawn > 0


def test_three_robots_in_order_are_told_from_robots_at_random():
    rng = np.random.default_rng(0)
    ordered = np.linspace(0.1, 0.5, 3) + 0.1 * rng.uniform(size=(10, 3))
    options = {"permutations": 4000, "rng": rng}
    assert order_test(ordered, np.array([0.2, 0.3, 0.9]), **options) < 0.001
    shuffled = rng.permuted(ordered, axis=1)
    assert order_test(shuffled, np.array([0.2, 0.3, 0.9]), **options) > 0.05


@pytest.mark.parametrize(
    ("headline", "b", "expected"),
    [
        pytest.param(WORSE, 0.4, "same order", id="worse-on-both"),
        pytest.param(WORSE, -0.4, "opposite order", id="worse-in-one-better-in-the-other"),
        pytest.param(BOTH, 0.4, "cannot be told apart", id="headline-unclear"),
        pytest.param(WORSE, 0.0, "cannot be told apart", id="people-see-no-difference"),
        pytest.param(None, 0.4, "unknown", id="one-search-seed"),
    ],
)
def test_an_order_is_claimed_only_where_both_have_one(headline, b, expected):
    people = difference([0.5] * 8, [0.5 + b] * 8)
    assert verdict(headline, people, alpha=0.05) == expected


def test_without_people_the_order_is_unknown():
    assert verdict(WORSE, difference([], []), alpha=0.05) == "unknown"


def test_three_people_are_too_few_for_any_order():
    people = difference([0.0] * 3, [1.0] * 3)
    assert people.p == 0.25
    assert verdict(WORSE, people, alpha=0.05) == "cannot be told apart"

"""Robots side by side: numbers from points, differences by seed, and what is no comparison."""

from __future__ import annotations

from pathlib import Path

import pytest

from rigid.errors import UserError
from rigid.frontier.comparison import compare, numbers_of, repeat_spread
from rigid.frontier.intervals import upper_bound
from rigid.frontier.result import Frontier

IDENTITY = {"task": {"name": "reach"}, "preset": {"iterations": 40}, "measure": "lsgan"}


def point(seed: int, height: float, naturalness: float = 0.9) -> dict[str, object]:
    return {
        "id": f"s{seed}", "seed": seed, "naturalness": naturalness, "naturalness_own": None,
        "adversarialness": height, "faults": 0, "episodes": 10,
    }  # fmt: skip


def robot(heights: dict[int, float], **changes) -> Frontier:
    """A robot whose worst human at naturalness 0.9 harms by `heights`, seed by seed."""
    points = [point(seed, height) for seed, height in heights.items()]
    data = {
        "points": points, "canonical": {"adversarialness": 0.0}, "return_range": [-1.0, 1.0],
        "auc_by_seed": {str(seed): 0.5 for seed in heights},
    }  # fmt: skip
    return Frontier(Path("run"), {**data, **changes})


def compared(a, b, theirs=IDENTITY):
    return compare({"a": a, "b": b}, {"a": IDENTITY, "b": theirs})


def test_numbers_are_computed_from_the_points():
    numbers = numbers_of(robot({0: 0.2, 1: 0.4}))
    assert numbers["worst_at"].by_seed == {"0": 0.2, "1": 0.4}
    assert numbers["worst_at"].mean == pytest.approx(0.3)
    # The hull is flat up to 0.9, then falls to the anchor.
    assert numbers["auc"].by_seed["1"] == pytest.approx(0.4 * 0.95)
    assert numbers["auc_natural"].by_seed["1"] == pytest.approx(0.4 * 0.75)


def test_worst_at_looks_from_the_level_that_was_asked_for():
    assert numbers_of(robot({0: 0.2}), level=0.95)["worst_at"].by_seed == {"0": 0.0}


def test_hull_at_is_the_height_at_the_level_that_was_asked_for():
    # Half-way between the human at 0.9 and the anchor at 1.
    assert numbers_of(robot({0: 0.2}), level=0.95)["hull_at"].by_seed["0"] == pytest.approx(0.1)


def test_a_step_over_the_threshold_moves_worst_at_but_hardly_the_hull():
    below, above = (
        robot({}, points=[point(0, 0.8, naturalness)], auc_by_seed={"0": 0.5})
        for naturalness in (0.899, 0.901)
    )
    found = compared(below, above)[1].against
    assert found["worst_at"].mean == pytest.approx(0.8)
    assert found["hull_at"].mean == pytest.approx(0.8 - 0.8 * 0.1 / 0.101)


def test_the_upper_bound_of_a_number_is_that_of_its_seeds():
    number = numbers_of(robot({0: 0.01, 1: 0.02, 2: 0.06}))["worst_at"]
    assert number.upper_bound == upper_bound([0.01, 0.02, 0.06]) > number.interval.high


def test_the_first_robot_is_the_baseline_of_all():
    rows = compared(robot({0: 0.2, 1: 0.4}), robot({0: 0.3, 1: 0.5}))
    assert [row.name for row in rows] == ["a", "b"]
    assert rows[0].against is None
    assert rows[1].against["worst_at"].mean == pytest.approx(0.1)


def test_what_seeds_share_cancels_in_the_difference():
    rows = compared(robot({0: 0.0, 1: 0.8, 2: 0.4}), robot({0: 0.1, 1: 0.9, 2: 0.5}))
    low, high = rows[1].against["worst_at"].interval
    assert (low, high) == (pytest.approx(0.1), pytest.approx(0.1))


def test_robots_are_paired_on_the_seeds_that_both_have():
    rows = compared(robot({0: 0.2, 1: 0.4}), robot({1: 0.5, 2: 0.9}))
    assert rows[1].against["worst_at"].seeds == ("1",)
    assert rows[1].numbers["worst_at"].mean == pytest.approx(0.7)


def test_robots_may_differ_in_robot_human_and_canonical_data():
    others = {"robot": "x", "human": "y", "canonical": "z"}
    compared(robot({0: 0.2}), robot({0: 0.2}), {**IDENTITY, **others})


UNLIKE = {
    "range": (
        {"return_range": [-2.0, 1.0]}, {},
        r"their ranges of adversarialness are \[-1.0, 1.0\] and \[-2.0, 1.0\]; measure both with",
    ),
    "task": ({}, {"task": {"name": "feed"}}, "one was measured in task reach, the other in feed$"),
    "budget": ({}, {"preset": {"iterations": 9}}, "preset.iterations is 40 for the one and 9 for"),
    "preset": (
        {"preset": "demo"}, {"preset": {"iterations": 9}},
        r"preset.iterations is 40 for the one and 9 for the other \(presets None and demo\)",
    ),
    "measure": ({}, {"measure": "mmd"}, "measure is lsgan for the one and mmd for the other"),
    "lambdas": ({}, {"lambdas": [1.0]}, r"their λ are None and \[1.0\]; null is a search"),
}  # fmt: skip


@pytest.mark.parametrize(("data", "identity", "message"), UNLIKE.values(), ids=UNLIKE)
def test_measurements_that_were_made_otherwise_are_refused(data, identity, message):
    with pytest.raises(UserError, match=f"^a and b cannot be compared: {message}"):
        compared(robot({0: 0.2}), robot({0: 0.2}, **data), {**IDENTITY, **identity})


def test_robots_without_a_common_seed_are_refused():
    with pytest.raises(UserError, match=r"they share no search seed \(0 and 1, 2\); add seeds"):
        compared(robot({0: 0.2}), robot({1: 0.2, 2: 0.2}))


def test_a_point_off_the_axes_is_named():
    with pytest.raises(UserError, match=r"run/frontier\.json: points must lie in \[0, 1\]"):
        numbers_of(robot({0: 7.0}))


def test_a_repeat_spreads_by_the_interval_of_a_difference_of_two_means():
    number = numbers_of(robot({0: 0.4, 1: 0.5, 2: 0.6}))["worst_at"]
    # t(2 degrees of freedom) times 0.1 times the root of 2/3.
    assert repeat_spread(number) == pytest.approx(4.302653 * 0.1 * (2 / 3) ** 0.5)


def test_one_seed_says_nothing_of_a_repeat():
    assert repeat_spread(numbers_of(robot({0: 0.4}))["auc"]) is None

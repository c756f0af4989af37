"""Two robots and more, with people who met them."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.study.analysis.placing import place
from rigid.study.analysis.players import players_of
from rigid.study.analysis.robots import robot_order
from rigid.study.analysis.settings import AnalysisSettings
from tests.study.analysis.planted import episode, everybody, robot

HEIGHTS = {"a": {0: 0.30, 1: 0.32, 2: 0.31}, "b": {0: 0.60, 1: 0.63, 2: 0.61}}


def met(failures, people=8, kind="person"):
    """Players who all fail in so many of 4 episodes, by robot; half of them with each device."""
    records = [
        episode(f"P{number:02}", n, robot=key, success=float(n >= failed),
                device="mouse" if number % 2 else "xr-hand")
        for key, failed in failures.items() for number in range(people) for n in range(4)
    ]  # fmt: skip
    codes = {record.participant for record in records}
    return players_of(records, everybody(records, codes if kind == "scripted" else ()))


def ordered(failures, heights=HEIGHTS, **who):
    robots = {key: robot(key, heights=heights[key]) for key in heights}
    players = met(failures, **who)
    placed = [
        one for key, measured in robots.items()
        for one in place(measured, [player for player in players if player.robot == key])
    ]  # fmt: skip
    return robot_order(robots, placed, AnalysisSettings())


def test_people_who_fail_more_with_the_robot_that_measures_worse_agree():
    (pair,) = ordered({"a": 1, "b": 3}).pairs
    assert pair.people.mean == pytest.approx(0.5)
    assert pair.people.people == 8
    worst = pair.headlines[0]
    assert (worst.name, worst.verdict) == ("worst_at", "same order")
    assert worst.mean == pytest.approx(0.30, abs=0.01)


def test_people_may_disagree_with_the_measurement():
    (pair,) = ordered({"a": 3, "b": 1}).pairs
    assert pair.headlines[0].verdict == "opposite order"


def test_where_people_fail_alike_robots_cannot_be_told_apart():
    (pair,) = ordered({"a": 2, "b": 2}).pairs
    assert pair.people.p == 1.0
    assert {one.verdict for one in pair.headlines} == {"cannot be told apart"}


def test_scripts_are_no_people():
    (pair,) = ordered({"a": 1, "b": 3}, kind="scripted").pairs
    assert pair.people.people == 0
    assert pair.headlines[0].verdict == "unknown"


def test_who_met_one_robot_alone_is_not_compared():
    (pair,) = ordered({"a": 1}).pairs
    assert pair.people.people == 0


def test_three_robots_have_one_test_of_their_order():
    heights = {**HEIGHTS, "c": {0: 0.80, 1: 0.81, 2: 0.84}}
    found = ordered({"a": 0, "b": 2, "c": 4}, heights)
    assert len(found.pairs) == 3
    assert found.people == 8
    assert found.p < 0.001
    assert ordered({"a": 2, "b": 2, "c": 2}, heights).p == 1.0


def test_runs_of_unlike_measure_are_not_compared():
    robots = {key: robot(key, heights=HEIGHTS[key]) for key in HEIGHTS}
    robots["b"].runs[0].frontier.data["return_range"][0] = -30.0
    placed = place(robots["a"], met({"a": 1}))
    (pair,) = robot_order(robots, placed, AnalysisSettings()).pairs
    assert "their ranges of adversarialness" in pair.why
    assert not pair.headlines


def test_one_robot_has_no_order():
    assert robot_order({"a": robot()}, place(robot(), met({"a": 1})), AnalysisSettings()) is None


def test_where_nobody_played_there_is_no_order():
    assert robot_order({"a": robot("a"), "b": robot("b")}, [], AnalysisSettings()) is None


def test_the_same_study_gives_the_same_p():
    first, second = (ordered({"a": 1, "b": 2}, people=20).pairs[0].people.p for _ in range(2))
    assert first == second
    assert np.isfinite(first)

"""Failure of a robot with people, and the rows of the tables."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.prediction.assembling import among, human_rows, table_rows
from tests.benchmarks.prediction.samples import HUMANS, meeting, subject


def met(**meetings):
    names = {"pair": "pair-1", "female": "female", "tremor": "tremor-1"}
    everyone = {names[name]: found for name, found in meetings.items()}
    return replace(subject(0, 0.3, 0.2), meetings=everyone)


def test_every_human_counts_once():
    robot = met(pair=meeting(0.9), female=meeting(0.3), tremor=meeting(0.0))
    assert robot.failure(HUMANS, "adversarialness") == pytest.approx(0.4)


def test_unhelped_is_what_success_leaves():
    robot = met(pair=meeting(0.9, success=0.25))
    assert robot.failure(among("pairs", HUMANS), "unhelped") == 0.75


def test_the_error_of_adversarialness_is_that_of_returns_over_the_range():
    robot = met(pair=meeting(0.9, std=72.0, episodes=100))
    assert robot.failure_se(among("pairs", HUMANS), "adversarialness") == pytest.approx(0.01)


def test_faulted_episodes_say_nothing():
    robot = met(pair=meeting(0.9, success=0.5, episodes=100, faults=75))
    assert robot.failure_se(among("pairs", HUMANS), "unhelped") == pytest.approx(0.1)


def test_the_error_over_humans_shrinks_with_their_number():
    robot = met(pair=meeting(0.9), female=meeting(0.9), tremor=meeting(0.9))
    alone = robot.failure_se(HUMANS[:1], "unhelped")
    assert robot.failure_se(HUMANS, "unhelped") == pytest.approx(alone / 3**0.5)


def test_groups_are_told_apart():
    assert [human.name for human in among("bodies", HUMANS)] == ["female"]
    assert among("all", HUMANS) == list(HUMANS)


def test_a_robot_of_one_seed_has_the_same_columns_as_any():
    one = subject(0, 0.3, 0.2)
    single = replace(one, frontier={**one.frontier, "auc_interval": None})
    with_interval, without = table_rows([one, single], HUMANS)
    assert list(with_interval) == list(without)
    assert without["auc_low"] is None


def test_there_is_a_row_for_every_robot_with_every_human():
    rows = human_rows([subject(0, 0.3, 0.2), subject(1, 0.4, 0.5)], HUMANS)
    assert len(rows) == 6
    assert rows[3] == {
        "robot": "i006-s1", "human": "pair-1", "group": "pairs", "seed": 100, "episodes": 100,
        "faults": 0, "success": 0.5, "adversarialness": 0.5, "return": 0.0, "return_std": 72.0,
    }  # fmt: skip

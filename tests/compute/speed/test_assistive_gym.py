"""Assistive Gym's figures stand beside ours at the same rate of control."""

from __future__ import annotations

import pytest

from rigid.compute.speed.assistive_gym import beside_assistive_gym
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.task import ItchScratching


@pytest.fixture(scope="module")
def found():
    return beside_assistive_gym(1, ItchScratching(ItchScratchingParameters(horizon=3)))


def test_control_is_at_their_rate(found):
    assert found["control_hz"] == 10.0


def test_theirs_are_said_to_be_of_another_place(found):
    assert found["theirs_measured_in_this_run"] is False
    assert (found["stepping"]["theirs"], found["with_resets"]["theirs"]) == (255.0, 39.0)


def test_the_ratio_is_ours_over_theirs(found):
    row = found["with_resets"]
    assert row["ratio"] == pytest.approx(row["ours"] / 39.0, abs=0.06)


def test_resets_only_take_time(found):
    assert found["with_resets"]["ours"] < found["stepping"]["ours"]

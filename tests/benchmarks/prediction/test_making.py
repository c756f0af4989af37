"""What is kept is used again, and refused where it is not what the study asks for."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace

import pytest

from benchmarks.prediction.making import Workplace
from benchmarks.prediction.plan import PLAN
from benchmarks.prediction.running import expected_seconds
from benchmarks.robots import RobotPlan
from rigid.errors import UserError
from rigid.policies.loading import BUNDLED
from rigid.tasks.registry import make_task

VANILLA = RobotPlan(iterations=100, seed=0)
FEMALE = next(human for human in PLAN.humans() if human.name == "female")


@pytest.fixture
def place(tmp_path):
    """A study of the bundled robot alone, which is trained already."""
    plan = replace(PLAN, robots=(VANILLA,), pairs=(), episodes=2)
    found = Workplace(plan, tmp_path)
    shutil.copytree(str(BUNDLED / "itch-scratching" / "vanilla"), found.robot(VANILLA))
    return found


def test_a_finished_robot_is_not_trained_again(place):
    before = {path: path.stat().st_mtime_ns for path in place.robot(VANILLA).iterdir()}
    place.make_robot(VANILLA)
    assert before == {path: path.stat().st_mtime_ns for path in place.robot(VANILLA).iterdir()}


@pytest.mark.parametrize(
    ("change", "difference"),
    [
        ({"iterations": 6}, "made with settings.iterations 100, but the study asks for 6"),
        ({"seed": 3}, "made with seed 0, but the study asks for 3"),
        ({"std": (0.5, 0.2)}, r"made with settings.std \[0.2, 0.05\], .* asks for \(0.5, 0.2\)"),
    ],
)
def test_a_robot_that_was_made_otherwise_is_refused(place, change, difference):
    other = replace(VANILLA, **change)
    place.robot(VANILLA).rename(place.robot(other))
    with pytest.raises(UserError, match=difference) as refusal:
        place.make_robot(other)
    assert str(refusal.value).endswith("delete it, or choose another place with --out")


def test_a_meeting_is_played_once(place, capsys):
    first = place.meet(VANILLA, FEMALE)
    assert "i100-s0 meets female" in capsys.readouterr().out
    assert place.meet(VANILLA, FEMALE) == first
    assert capsys.readouterr().out == ""
    assert (first["episodes"], first["identity"]["seed"]) == (2, FEMALE.seed)
    assert first["identity"]["task"]["parameters"]["body"] == "female"


def test_a_meeting_of_another_budget_is_refused(place):
    kept = {"identity": {"episodes": 7}, "adversarialness": 0.5}
    path = place.meeting(VANILLA, FEMALE)
    path.parent.mkdir(parents=True)
    path.write_text(json.dumps(kept), encoding="utf-8")
    with pytest.raises(UserError, match=r"female.json was made with episodes 7, .* asks for 2"):
        place.meet(VANILLA, FEMALE)


def test_what_is_there_takes_no_time(place):
    before = expected_seconds(place, speed=1000.0)
    path = place.meeting(VANILLA, FEMALE)
    path.parent.mkdir(parents=True)
    path.touch()
    assert expected_seconds(place, speed=1000.0) == pytest.approx(before - 1 - 2 * 100 * 0.5 / 1000)


def test_the_plan_asks_for_enough_robots_that_are_all_different():
    names = [robot.name for robot in PLAN.robots]
    assert len(set(names)) == len(names) >= 8


def test_no_unseen_human_is_the_one_that_searches_began_from():
    usual = make_task("itch-scratching").describe()
    for human in PLAN.humans():
        task = make_task("itch-scratching", **human.changes)
        assert human.pair is not None or task.describe() != usual
    assert 0 not in PLAN.pairs  # Seed of the bundled pair.

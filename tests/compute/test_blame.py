"""Whose fault was it? Verdicts by hand, and a whole toy run that is blamed in two goes."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from rigid.compute import blame as blaming
from rigid.compute.blame import blame, harmful_points, verdict
from rigid.errors import UserError
from rigid.frontier.result import Frontier
from rigid.learning.best_response import ResponseSettings
from rigid.tasks import registry
from tests.compute.tiny import FilmedReach

QUICK = ResponseSettings(iterations=2, imitation=1, episodes=4, hidden=(4,))


def found(robot, same, everything, successes=(None, None)):
    harms = {"robot": robot, "same_view": same, "sees_everything": everything}
    success = {"robot": 0.0, "same_view": successes[0], "sees_everything": successes[1]}
    return {name: {"adversarialness": y, "success": success[name]} for name, y in harms.items()}


@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        (found(0.8, 0.8, 0.8, (0.0, 0.1)), (0.1, "no robot could help", 0.0)),
        (found(0.8, 0.7, 0.6, (0.5, 0.2)), (0.5, "nearly solved", 0.2)),
        (found(0.8, 0.3, 0.6, (0.9, 0.2)), (0.9, "another policy copes", 0.5)),
        # Without a success it is the share of the harm beyond canonical play that is undone.
        (found(0.6, 0.6, 0.15), (0.9, "another policy copes", 0.45)),
        (found(0.6, 0.6, 0.4), (0.4, "nearly solved", 0.2)),
        (found(0.6, 0.9, 0.7), (0.0, "no robot could help", 0.0)),
    ],
)
def test_verdicts_by_hand(entries, expected):
    said = verdict(entries, anchor=0.1)
    assert said["solvable"] == pytest.approx(expected[0])
    assert said["verdict"] == expected[1]
    assert said["regret"] == pytest.approx(expected[2])


def test_only_harmful_points_on_the_frontier_are_looked_at_the_most_natural_first():
    def point(name, naturalness, harm, on):
        return {"id": name, "naturalness": naturalness, "adversarialness": harm, "on_frontier": on}

    points = [point("a", 0.1, 0.9, on=True), point("b", 0.8, 0.5, on=True),
              point("c", 0.9, 0.12, on=True), point("d", 0.7, 0.6, on=False),
              point("e", 0.95, None, on=True)]  # fmt: skip
    data = {"points": points, "canonical": {"adversarialness": 0.1}}
    assert harmful_points(Frontier(Path("run"), data)) == ["b", "a"]


@pytest.fixture
def run(single_run, tmp_path, monkeypatch):
    """A copy of a toy measurement, whose task counts as RIGID's own."""
    recipe = registry._Recipe(FilmedReach, None)
    monkeypatch.setitem(registry._BUILTIN, "toy-reach", lambda: recipe)
    return shutil.copytree(single_run.directory, tmp_path / "run")


def test_what_is_known_is_kept_and_not_trained_again(run, monkeypatch):
    first = blame(run, points=["s0-r1-l1"], settings=QUICK)
    assert first.keys() == {"s0-r1-l1"}
    assert first == json.loads((run / "blame.json").read_text())
    trained = []
    monkeypatch.setattr(
        blaming, "best_response", lambda *_, **__: trained.append(1) or pytest.fail("trained")
    )
    assert blame(run, points=["s0-r1-l1"], settings=QUICK) == first
    assert not trained


def test_a_point_that_is_none_is_named(run):
    with pytest.raises(UserError, match=r"has no point 's9-r1-l1': frontier\.json lists their ids"):
        blame(run, points=["s9-r1-l1"], settings=QUICK)


def test_another_robot_is_refused(run, base):
    shutil.copytree(base / "pair" / "robot", run / "other")
    from rigid.policies.native import save_policy
    from tests.toys import untrained

    task = FilmedReach()
    save_policy(untrained(task.robot, seed=5), run / "other", agent="robot",
                task=task.describe(), provenance={})  # fmt: skip
    with pytest.raises(UserError, match="is not the one that was measured: name it with --robot"):
        blame(run, robot=str(run / "other"), settings=QUICK)


def test_a_damaged_file_is_named(run):
    (run / "blame.json").write_text("{")
    with pytest.raises(UserError, match=r"blame\.json is damaged: delete it to train"):
        blame(run, points=["s0-r1-l1"], settings=QUICK)


def test_a_task_that_is_not_rigids_own_is_refused(single_run):
    with pytest.raises(
        UserError, match="not RIGID's own, and what a file names is not opened: name it"
    ):
        blame(single_run.directory, settings=QUICK)


class LaterReach(FilmedReach):
    """The next version of the task."""

    def describe(self):
        return {**super().describe(), "version": 1}


def test_a_task_that_the_user_names_is_taken_if_it_is_the_one_that_was_measured(
    single_run, tmp_path
):
    run = shutil.copytree(single_run.directory, tmp_path / "run")
    told = blame(run, task=FilmedReach(), points=["s0-r1-l1"], settings=QUICK)
    assert told.keys() == {"s0-r1-l1"}
    with pytest.raises(UserError, match="with other parameters or another version than the task"):
        blame(run, task=LaterReach(), settings=QUICK)


def test_the_command_prints_one_line_for_each_human(run, capsys, monkeypatch):
    from rigid.cli import run as rigid

    monkeypatch.setattr(
        blaming, "_blame_one",
        lambda *_: {**verdict(found(0.8, 0.3, 0.6, (0.9, 0.2)), 0.1), "robot": {
            "adversarialness": 0.8, "success": 0.0}},
    )  # fmt: skip
    assert rigid(["blame", str(run), "--points", "s0-r1-l1"]) == 0
    out = capsys.readouterr().out
    assert "s0-r1-l1       0.800   0.300   0.500     0.00 → 0.90  another policy copes" in out

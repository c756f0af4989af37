"""Robots of finished runs with humans that they were not made for."""

from __future__ import annotations

import json
import shutil

import pytest

from rigid.compute.evaluation import evaluate
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.compute.unseen import UNSEEN_SEED, play_unseen
from rigid.errors import UserError
from rigid.frontier.result import load_frontier
from rigid.policies.loading import load_policy
from rigid.policies.native import save_policy
from rigid.tasks import registry
from tests.compute.tiny import FilmedReach
from tests.toys import untrained

TASK = FilmedReach()


@pytest.fixture
def run(single_run, tmp_path, monkeypatch):
    """A copy of a toy measurement, whose task counts as RIGID's own."""
    recipe = registry._Recipe(FilmedReach, None)
    monkeypatch.setitem(registry._BUILTIN, "toy-reach", lambda: recipe)
    return shutil.copytree(single_run.directory, tmp_path / "run")


@pytest.fixture
def other(tmp_path):
    """A human that no run was made with."""
    save_policy(
        untrained(TASK.human, seed=7), tmp_path / "other",
        agent="human", task=TASK.describe(), provenance={},
    )  # fmt: skip
    return str(tmp_path / "other")


def measured(directory):
    return load_frontier(directory), read_settings(RunDirectory(directory))["identity"]


def change(directory, **fields):
    path = directory / "frontier.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), **fields}))


def test_every_robot_plays_every_human_but_its_own(run, base, other):
    own = str(base / "pair" / "human")
    played = play_unseen([measured(run)] * 2, [own, other, "builtin:passive"], episodes=4)
    assert [one.robot for one in played] == [0, 0, 1, 1]
    assert {one.episodes for one in played} == {4}


def test_success_is_that_of_fresh_episodes(run, base, other):
    (played,) = play_unseen([measured(run)], [other], episodes=20)
    robot = load_policy(str(base / "pair" / "robot"), task=TASK, agent="robot")
    human = load_policy(other, task=TASK, agent="human")
    found = evaluate(TASK, robot, human, episodes=20, seed=UNSEEN_SEED)
    assert played.success == found["success"]


def test_a_run_with_none_but_its_own_human_is_left_out(run, base):
    frontier, identity = measured(run)
    others = (frontier, {**identity, "human": "0" * 64})
    (played,) = play_unseen(
        [(frontier, identity), others], [str(base / "pair" / "human")], episodes=4
    )
    assert played.robot == 1


def test_nobody_but_the_own_human_is_refused(run, base):
    with pytest.raises(UserError, match="nobody but the robots' own synthetic human: name those"):
        play_unseen([measured(run)], [str(base / "pair" / "human")], episodes=4)


def test_progress_is_told_of_every_pair(run, other):
    seen = []

    def track(pairs):
        for pair in pairs:
            seen.append(pair.run)
            yield pair

    play_unseen([measured(run)] * 3, [other], episodes=2, track=track)
    assert seen == [0, 1, 2]


def test_another_robot_than_the_measured_one_is_refused(run, other):
    frontier, identity = measured(run)
    with pytest.raises(
        UserError,
        match=r"/run: robot .* is not the one that was measured: put it back; --humans needs",
    ):
        play_unseen([(frontier, {**identity, "robot": "0" * 64})], [other], episodes=2)


def test_a_robot_that_is_gone_is_named(run, other):
    change(run, robot="robots/gone")
    with pytest.raises(
        UserError,
        match=r"/run: robot 'robots/gone' is no directory: .*; --humans needs the robot where it w",
    ):
        play_unseen([measured(run)], [other], episodes=2)


@pytest.mark.parametrize("spec", ["exec:rm -rf x", "python:module:factory", "sb3:robot.zip"])
def test_a_command_that_a_run_names_is_not_run(run, other, spec):
    change(run, robot=spec)
    with pytest.raises(UserError, match=r"its robot '.*' would run code that the run names: leave"):
        play_unseen([measured(run)], [other], episodes=2)


def test_a_task_that_is_not_rigids_own_is_not_imported(single_run, other):
    with pytest.raises(UserError, match="nothing that a run names is imported: leave out --humans"):
        play_unseen([measured(single_run.directory)], [other], episodes=2)


def test_a_human_that_is_named_twice_is_refused(run, other, tmp_path):
    again = shutil.copytree(other, tmp_path / "again")
    with pytest.raises(UserError, match="are the same human: name it once"):
        play_unseen([measured(run)], [other, str(again)], episodes=2)

"""Robust GT: which adversaries are taken, and a toy run that a robot learns on from."""

from __future__ import annotations

import json
import shutil
from contextlib import nullcontext
from dataclasses import replace

import pytest

from rigid.compute.listening import Silence
from rigid.errors import UserError
from rigid.policies.native import load_native
from rigid.robots.robust_gt import (
    NoTeachersError,
    RobustSettings,
    choose_adversaries,
    take_lesson,
    train_robust_gt,
)
from rigid.robots.rounds import Manner, seeds_not_used, train_in_rounds
from rigid.tasks import registry
from tests.compute.tiny import TINY, FilmedReach, hasten_referees
from tests.robots.quick import VANILLA, Seen, names, same
from tests.toys import untrained

SETTINGS = RobustSettings(
    naturalness=(0.0, 1.0), adversaries=2, share=0.5, training=replace(VANILLA, episodes=8)
)


@pytest.fixture
def run(single_run, tmp_path, monkeypatch):
    """A copy of a toy measurement, whose task counts as RIGID's own."""
    recipe = registry._Recipe(FilmedReach, None)
    monkeypatch.setitem(registry._BUILTIN, "toy-reach", lambda: recipe)
    hasten_referees(monkeypatch)
    return shutil.copytree(single_run.directory, tmp_path / "run")


def train(lesson, out, *, settings=SETTINGS, report=None):
    train_robust_gt(
        lesson, settings, seed=0, out=out, canonical_episodes=5, report=report or Seen()
    )
    return out


def point(name, seed, naturalness, total):
    return {"id": name, "seed": seed, "naturalness": naturalness, "return": total}


def test_only_adversaries_in_the_range_are_taken_the_most_harmful_of_each_seed_first():
    points = [
        point("weird", 0, 0.1, -99.0), point("canonical", 0, 0.9, -98.0),
        point("second", 0, 0.5, -60.0), point("first", 0, 0.2, -80.0),
        point("mild", 1, 0.8, -5.0), point("third", 0, 0.4, -50.0),
    ]  # fmt: skip
    taken = choose_adversaries(points, RobustSettings(adversaries=3))
    assert [p["id"] for p in taken] == ["first", "mild", "second"]


def test_points_without_a_return_are_not_taken():
    assert choose_adversaries([point("lost", 0, 0.5, None)], RobustSettings()) == []


def test_a_robot_goes_on_from_the_one_that_was_measured(run, tmp_path):
    """With no iteration to learn in it would act as before; here it learned."""
    lesson = take_lesson([run], SETTINGS)
    robot = load_native(train(lesson, tmp_path / "robot"))
    assert robot.card.architecture == load_native(run.parent / "robot").card.architecture
    made_by = robot.card.provenance
    assert made_by["recipe"] == "robust-gt"
    points = json.loads((run / "frontier.json").read_text())["points"]
    worst = min(points, key=lambda p: p["return"])
    assert made_by["adversaries"][0]["id"] == worst["id"]
    sha = load_native(run / "adversaries" / worst["id"]).card.sha256
    assert made_by["adversaries"][0]["sha256"] == sha


def test_from_scratch_starts_elsewhere(run, tmp_path):
    lesson = take_lesson([run], SETTINGS)
    anew = train(lesson, tmp_path / "anew", settings=replace(SETTINGS, from_scratch=True))
    assert not same(anew, train(lesson, tmp_path / "on"))


def test_an_interrupted_robot_ends_like_an_undisturbed_one(run, tmp_path):
    lesson = take_lesson([run], SETTINGS)
    undisturbed = train(lesson, tmp_path / "one")
    with pytest.raises(KeyboardInterrupt):
        train(lesson, tmp_path / "other", report=Seen(last=11))
    seen = Seen()
    train(lesson, tmp_path / "other", report=seen)
    assert seen.iterations == [10, 11, 12, 13]
    assert seen.begun[2] == 10
    assert names(tmp_path / "other") == names(undisturbed)
    assert same(tmp_path / "other", undisturbed)


@pytest.mark.parametrize(
    ("preset", "cure"),
    [
        ("demo", "measure with --preset paper, which finds more of them, or widen"),
        ("paper", "search with more --seeds or --lambdas, or widen the range with --naturalness"),
    ],
)
def test_a_run_without_an_adversary_in_the_range_is_refused_with_a_cure(run, preset, cure):
    settings = replace(SETTINGS, naturalness=(0.0, 1e-9))
    frontier = json.loads((run / "frontier.json").read_text()) | {"preset": preset}
    for adversary in frontier["points"]:
        adversary["naturalness"] = 0.5
    (run / "frontier.json").write_text(json.dumps(frontier))
    with pytest.raises(NoTeachersError, match=rf"no adversary .* in \[0, 1e-09\]: {cure}"):
        take_lesson([run], settings)


def test_another_robot_than_the_measured_one_is_refused(run, tmp_path):
    from rigid.policies.native import save_policy

    task = FilmedReach()
    save_policy(
        untrained(task.robot, seed=5), tmp_path / "else",
        agent="robot", task=task.describe(), provenance={},
    )  # fmt: skip
    with pytest.raises(UserError, match="is not the one that was measured: name it"):
        take_lesson([run], SETTINGS, robot=str(tmp_path / "else"))


@pytest.mark.slow
def test_a_robot_that_the_user_names_may_be_code_and_one_that_the_run_names_may_not(run):
    with pytest.raises(UserError, match="there is no module 'no_such_arm'"):
        take_lesson([run], SETTINGS, robot="python:no_such_arm:make")
    frontier = json.loads((run / "frontier.json").read_text())
    (run / "frontier.json").write_text(json.dumps(frontier | {"robot": "python:no_such_arm:make"}))
    with pytest.raises(UserError, match="would run code that a file names: name it yourself"):
        take_lesson([run], SETTINGS)


def go_on(run, out, *, settings=SETTINGS):
    return train_in_rounds(
        run, settings, replace(TINY, seeds=(0,)), rounds=2, seed=0, out=out,
        canonical_episodes=5, robot=None, training=lambda _: nullcontext(Seen()),
        searching=lambda _: nullcontext(Silence()),
    )  # fmt: skip


def test_two_rounds_search_the_robot_between_with_seeds_of_their_own(run, tmp_path):
    out = tmp_path / "robust"
    runs = go_on(run, out)
    assert runs == [run, out / "round-1" / "frontier"]
    between = json.loads((runs[1] / "settings.json").read_text())
    assert between["seeds"] == [1]
    assert seeds_not_used(runs, 2) == (2, 3)
    learned_from = load_native(out).card.provenance
    assert learned_from["from"] == load_native(out / "round-1" / "robot").card.sha256
    assert {one["run"] for one in learned_from["adversaries"]} == {"run", "frontier"}
    with pytest.raises(UserError, match="already holds a robot"):
        go_on(run, out)


def test_rounds_search_as_the_run_did_that_they_begin_with(run, tmp_path):
    settings = json.loads((run / "settings.json").read_text())
    name = FilmedReach().feature_names[0]
    settings["identity"] |= {"features": name, "measure": "kl", "lambdas": [0.5]}
    settings["identity"]["adversary"]["memory"] = 2
    (run / "settings.json").write_text(json.dumps(settings))
    _, between = go_on(run, tmp_path / "robust")
    assert Manner.of(between) == Manner(name, "kl", 2, (0.5,))


def test_a_round_of_other_settings_is_not_gone_on_from(run, tmp_path):
    train(take_lesson([run], SETTINGS), tmp_path / "robust" / "round-1" / "robot")
    other = replace(SETTINGS, share=0.4)
    with pytest.raises(UserError, match=r"round-1.robot is from a training with other settings"):
        go_on(run, tmp_path / "robust", settings=other)

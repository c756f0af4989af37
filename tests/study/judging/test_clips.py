"""The motions that people see: those that were measured, and nothing that judges them."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.report.poses import decode_poses
from rigid.study.judging import prepare_clips, preview_trials, trials_for
from tests.study.judging.sources import (
    ROBOT,
    STEPS,
    STILL,
    TASK,
    plan_of,
    pushes,
    rater,
    states_of,
    write_pairs,
    write_recorded_pair,
)
from tests.toys import untrained


def prepared(plan, data, **options):
    return prepare_clips(plan, data, task=TASK, robots={"a": ROBOT}, **options)


def poses_of(clip):
    shown = json.loads(clip)
    return decode_poses(shown["poses"], frames=shown["frames"], bodies=len(shown["bodies"]))


def seen(states):
    return np.asarray(TASK.replay(states)["poses"])


def shown(plan, clips):
    """The clips of a participant by pair and who stands there."""
    found = {}
    for trial in trials_for(plan, 1, rater()):
        for role, key in trial.keys.items():
            name = trial.clips[role]
            found[name.pair, name.who, name.moment] = clips.find(rater(), key)
    return found


def test_replays_are_the_episodes_that_were_measured(tmp_path):
    plan = plan_of(write_pairs(tmp_path, "naturalness", 2), "naturalness", count=2)
    found = shown(plan, prepared(plan, tmp_path / "data"))
    assert len(found) == 6
    for (pair, who, _), clip in found.items():
        push = pushes(pair)[("first", "second", "reference").index(who)]
        np.testing.assert_allclose(poses_of(clip), seen(states_of(push)), atol=1e-4)


def test_stills_are_one_frame_and_the_reference_moves(tmp_path):
    plan = plan_of(
        write_pairs(tmp_path, "correspondence", 1), "correspondence", count=1, show="snapshot"
    )
    found = shown(plan, prepared(plan, tmp_path / "data"))
    still = poses_of(found[0, "first", STILL])
    np.testing.assert_allclose(still, seen(states_of(pushes(0)[0]))[[STILL]], atol=1e-4)
    assert len(poses_of(found[0, "reference", None])) == STEPS + 1


def test_a_check_shows_the_reference_at_the_moment_of_the_other(tmp_path):
    path = write_pairs(tmp_path, "correspondence", 1)
    plan = plan_of(path, "correspondence", count=1, show="snapshot", attention_checks=1)
    found = shown(plan, prepared(plan, tmp_path / "data"))
    itself = poses_of(found[0, "reference", STILL])
    np.testing.assert_allclose(itself, seen(states_of(pushes(0)[2]))[[STILL]], atol=1e-4)


def test_nothing_tells_what_rigid_thinks_of_an_episode(tmp_path):
    plan = plan_of(write_pairs(tmp_path, count=1), count=1)
    for clip in shown(plan, prepared(plan, tmp_path / "data")).values():
        assert json.loads(clip).keys() == {"dt", "frames", "bodies", "itch", "poses"}


def test_keys_of_others_and_made_up_ones_show_nothing(tmp_path):
    plan = plan_of(write_pairs(tmp_path, count=1), count=1)
    clips = prepared(plan, tmp_path / "data")
    key = trials_for(plan, 1, rater(0))[0].keys["left"]
    assert clips.find(rater(0), key)
    for who, wrong in [(rater(1), key), (rater(0), ""), (rater(0), "c0"), (rater(0), "../x")]:
        assert clips.find(who, wrong) is None


def test_a_preview_shows_motions_too(tmp_path):
    plan = plan_of(write_pairs(tmp_path, count=1), count=1)
    clips = prepared(plan, tmp_path / "data")
    (trial,) = preview_trials(plan, "rater", 1)
    assert clips.preview("rater", 1, trial.keys["right"])
    assert clips.preview("rater", 1, "else") is None


def test_motions_are_made_once_and_need_no_run_afterwards(tmp_path):
    plan = plan_of(write_pairs(tmp_path, count=2), count=2)
    said = []
    first = prepared(plan, tmp_path / "data", say=said.append)
    assert len(said) == 1
    shutil.rmtree(tmp_path / "run")
    assert prepared(plan, tmp_path / "data", say=said.append) == first
    assert len(said) == 1


def test_a_damaged_motion_is_made_again(tmp_path):
    plan = plan_of(write_pairs(tmp_path, count=1), count=1)
    first = prepared(plan, tmp_path / "data")
    for file in (tmp_path / "data" / "clips").glob("*.json"):
        file.write_bytes(b"{}")
    assert prepared(plan, tmp_path / "data") == first


def test_episodes_that_changed_are_refused(tmp_path):
    plan = plan_of(write_pairs(tmp_path, count=2), count=2)
    episodes = tmp_path / "run" / "adversaries"
    shutil.copy(episodes / "p0" / "episodes.npz", episodes / "p1" / "episodes.npz")
    with pytest.raises(UserError, match="has changed since pairs were picked from it"):
        prepared(plan, tmp_path / "data")


def test_pairs_of_another_task_are_refused(tmp_path):
    plan = plan_of(write_pairs(tmp_path, count=1), count=1)
    with pytest.raises(UserError, match=f"horizon = {STEPS}, but the study's task has 7"):
        prepare_clips(
            plan, tmp_path / "data", task=TASK.with_parameters(horizon=7), robots={"a": ROBOT}
        )


def test_a_recorded_human_meets_the_robot_again(tmp_path):
    path, actions = write_recorded_pair(tmp_path)
    plan = plan_of(path, "correspondence", count=1)
    clip = shown(plan, prepared(plan, tmp_path / "data"))[0, "second", None]
    member = json.loads(path.read_text())["pairs"][0]["second"]
    world = TASK.make_world(1, threads=1)
    step, states = world.reset(np.array([member["seed"]])), [world.snapshot()[0]]
    for action in actions:
        move, _ = ROBOT.act(step.robot_observation, ROBOT.initial_state(1), None)
        step = world.step(move, action[None])
        states.append(world.snapshot()[0])
    np.testing.assert_allclose(poses_of(clip), seen(np.array(states)), atol=2e-3)


def test_a_recorded_human_whose_robot_is_gone_names_the_robot(tmp_path):
    path, _ = write_recorded_pair(tmp_path)
    plan = plan_of(path, "correspondence", count=1)
    about = {"schema": 1, "identity": {}, "seeds": [0], "provenance": {"versions": {}}}
    (tmp_path / "run" / "settings.json").write_text(json.dumps(about))
    with pytest.raises(UserError, match="robot 'elsewhere'"):
        prepare_clips(
            plan, tmp_path / "data", task=TASK, robots={"a": untrained(TASK.robot, seed=9)}
        )

"""What people watch before they play or judge: canonical episodes that succeed."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from rigid.data.episodes import load_episodes, save_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.policies.native import save_policy
from rigid.report.poses import decode_poses
from rigid.study.judging import prepare_clips
from rigid.study.plan import Role, StudyPlan, WatchStage
from tests.study.judging.sources import HUMAN, TASK, rater
from tests.toys import untrained


@pytest.fixture
def robots(tmp_path):
    """Two robots on disk, each with four canonical episodes beside it, the first of which fails."""
    found = {}
    for seed, key in enumerate("ab"):
        folder, robot = tmp_path / key, untrained(TASK.robot, seed=seed)
        save_policy(robot, folder, agent="robot", task=TASK.describe(), provenance={})
        episodes = record(TASK, robot, HUMAN, episodes=4, seed=seed, batch=4, provenance={})
        helped = np.array([0.0, 1.0, 1.0, 1.0], dtype=np.float32)
        save_episodes(folder / "canonical.npz", replace(episodes, success=helped))
        found[key] = folder
    return found


def watching(robots, episodes):
    return StudyPlan(
        title="Watching", robots={key: str(folder) for key, folder in robots.items()},
        roles={"rater": Role(participants=1, stages=(WatchStage(episodes=episodes),))},
    )  # fmt: skip


def test_episodes_of_the_robots_come_in_turn(robots, tmp_path):
    both = prepare_clips(watching(robots, 3), tmp_path / "data", task=TASK).canonical
    (alone,) = prepare_clips(
        watching({"b": robots["b"]}, 1), tmp_path / "data", task=TASK
    ).canonical
    assert len(set(both)) == 3
    assert both[1] == alone


def test_episodes_that_fail_are_not_shown(robots, tmp_path):
    one = {"a": robots["a"]}
    shown = prepare_clips(watching(one, 3), tmp_path / "data", task=TASK).canonical
    episodes = load_episodes(robots["a"] / "canonical.npz", task=TASK)
    world = TASK.make_world(4, threads=1)
    world.reset(episodes.seeds)
    starts = [
        np.asarray(TASK.replay(np.stack([state, state]))["poses"][0]) for state in world.snapshot()
    ]
    for clip, start in zip(map(json.loads, shown), starts[1:], strict=True):
        poses = decode_poses(clip["poses"], frames=clip["frames"], bodies=len(clip["bodies"]))
        np.testing.assert_allclose(poses[0], start, atol=1e-4)
    with pytest.raises(UserError, match=r"3 of 4 canonical episodes .* but people watch 4"):
        prepare_clips(watching(one, 4), tmp_path / "data", task=TASK)


def test_only_a_role_that_watches_may_see_them(robots, tmp_path):
    plan = watching({"a": robots["a"]}, 2)
    clips = prepare_clips(plan, tmp_path / "data", task=TASK)
    assert [clips.find(rater(), key) for key in ("c0", "c1")] == list(clips.canonical)
    for key in ("c2", "c-1", "c01x", "c", "c99999"):
        assert clips.find(rater(), key) is None


def test_episodes_of_another_robot_are_refused(robots, tmp_path):
    episodes = record(
        TASK, untrained(TASK.robot, seed=1), HUMAN, episodes=4, seed=1, batch=4, provenance={}
    )
    far = replace(episodes, returns=episodes.returns - 100.0, success=np.ones(4, dtype=np.float32))
    save_episodes(robots["a"] / "canonical.npz", far)
    with pytest.raises(UserError, match="was recorded with another robot"):
        prepare_clips(watching({"a": robots["a"]}, 1), tmp_path / "data", task=TASK)

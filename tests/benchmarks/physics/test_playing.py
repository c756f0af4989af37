"""Closed loops: what is alike at every step, and what is noted."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.physics.people import LOUD, Flailing, human_named
from benchmarks.physics.plan import DEFAULT, LIMITS, SETTINGS, Setting
from benchmarks.physics.playing import WatchedWorld, play_block, starts_of, task_at
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters


@pytest.fixture(scope="module")
def synthetic():
    return human_named("canonical", np.arange(1))


def test_the_first_setting_is_the_tasks_and_all_last_as_long():
    usual = ItchScratchingParameters()
    assert (DEFAULT.step, DEFAULT.substeps) == (usual.physics_step, usual.substeps)
    assert {round(one.step * one.substeps, 12) for one in SETTINGS} == {0.1}


def test_a_return_may_move_by_a_fiftieth_of_its_range():
    (limit,) = (one for one in LIMITS if one.number == "return")
    assert limit.bound == pytest.approx(14.4)


def test_starts_and_noise_are_the_same_at_every_step():
    coarse, fine = (
        play_block("loud", one, count=2, seed=0, block=3) for one in (DEFAULT, SETTINGS[1])
    )
    np.testing.assert_array_equal(coarse.snapshots[0], fine.snapshots[0])
    np.testing.assert_array_equal(
        coarse.episodes.human_action[0], fine.episodes.human_action[0]
    )  # Later ones answer to what was seen.


def test_blocks_start_differently():
    one, other = (starts_of(4, seed=0, block=block)[0] for block in (0, 1))
    assert not np.isin(one, other).any()


def test_everyone_who_flails_is_told_by_the_seed_alone(synthetic):
    seen = np.ones((3, synthetic.observation_size))
    actions, _ = Flailing(np.array([5, 6, 7]), synthetic).act(seen, (), None)
    alone, _ = Flailing(np.array([6]), synthetic).act(seen[:1], (), None)
    np.testing.assert_array_equal(actions[1], alone[0])
    assert np.abs(actions[0] - actions[1]).max() > 0.1
    assert np.abs(actions).max() == 1.0


def test_the_loud_human_is_the_synthetic_one_with_more_noise(synthetic):
    loud, seen = human_named("loud", np.arange(2)), np.ones((400, synthetic.observation_size))
    means = [human.act(seen, (), None)[0] for human in (loud, synthetic)]
    np.testing.assert_array_equal(*means)
    sampled, _ = loud.sample(seen, (), np.random.default_rng(0))
    assert (sampled - sampled.mean(axis=0)).std() == pytest.approx(LOUD, rel=0.05)


def test_a_human_of_another_name_is_refused():
    with pytest.raises(ValueError, match="no human is called 'calm'"):
        human_named("calm", np.arange(1))


def test_the_deepest_overlap_and_the_fastest_joint_are_kept_until_a_reset():
    world = WatchedWorld(task_at(DEFAULT), 2)
    world.reset(np.arange(2))
    world._batch.bind("qvel")[1, 3] = 3.0
    seen = []
    for _ in range(4):
        world.step(np.zeros((2, 7)), np.zeros((2, 10)))
        seen.append(world.fastest.copy())
    assert seen[0][1] > 1.0 > seen[0][0]
    np.testing.assert_array_equal(seen[-1], seen[0])  # The servos brake.
    world.reset(np.arange(2))
    assert not world.fastest.any()


def test_old_poses_are_those_of_a_coarser_step_and_angles_stay_current():
    fine = Setting(0.005)
    fresh, old = (WatchedWorld(task_at(fine), 1, pose_age=age) for age in (1, 4))
    for world in (fresh, old):
        world.reset(np.arange(1))
    seen = [world.step(np.ones((1, 7)), np.ones((1, 10))) for world in (fresh, old)]
    sensors, data = old._sensors, old._scene.records["sensordata"]
    # Entry s is the state before physics step s: the fourth last is 0.02 s old.
    expected = sensors.poses(data[:, -4]).tip - task_at(fine).chest
    np.testing.assert_allclose(seen[1].human_observation[:, :3], expected, rtol=1e-6)
    assert np.abs(seen[0].human_observation[:, :3] - expected).max() > 1e-5
    np.testing.assert_array_equal(seen[0].features, seen[1].features)


def test_nothing_is_noted_of_a_step_that_ran_away():
    world = WatchedWorld(task_at(DEFAULT), 2)
    world.reset(np.arange(2))
    world._batch.bind("qpos")[1, 3] = np.deg2rad(5)  # Arm down along the body: into the arm rest.
    world._batch.bind("qpos")[1, 6] = 0
    world.step(np.zeros((2, 7)), np.zeros((2, 10)))
    np.testing.assert_array_equal(world.faulted, [False, True])
    assert world.penetration[1] == 0

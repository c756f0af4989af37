"""An episode's start depends on its seed and on nothing else."""

from importlib import resources

import mujoco
import numpy as np
import pytest

from rigid.errors import UserError
from rigid.tasks.bodies import human, jaco, kinematics, scratcher
from rigid.tasks.itch_scratching.starts import STARTS
from rigid.tasks.physics.starts import COUNT
from tests.tasks.scripted import random_actions


def play(world, seeds, steps=20):
    """What both agents see in every world, with the same actions in all of them."""
    rng, seen = np.random.default_rng(0), []
    step = world.reset(np.array(seeds))
    for _ in range(steps):
        seen.append(np.concatenate([step.robot_observation, step.human_observation], axis=1))
        robot, person = random_actions(rng, 1)
        step = world.step(np.repeat(robot, world.batch, 0), np.repeat(person, world.batch, 0))
    return np.array(seen)


def test_a_seed_plays_the_same_in_any_world_of_any_batch_on_any_number_of_threads(task):
    alone = play(task.make_world(1, threads=1), [7])
    among = play(task.make_world(5, threads=2), [1, 7, 3, 2, 7])
    np.testing.assert_array_equal(alone[:, 0], among[:, 1])
    np.testing.assert_array_equal(alone[:, 0], among[:, 4])


def test_a_fresh_world_starts_like_a_used_one(task):
    world = task.make_world(2, threads=1)
    first = play(world, [7, 8])
    np.testing.assert_array_equal(first, play(world, [7, 8]))


def test_the_first_observation_shows_the_start(task):
    world = task.make_world(1, threads=1)
    step = world.reset(np.array([5]))
    data = mujoco.MjData(task.model)
    data.qpos[:] = world._batch.bind("qpos")[0]
    mujoco.mj_kinematics(task.model, data)
    tip = data.site(scratcher.TIP_SITE).xpos
    np.testing.assert_allclose(step.human_observation[0, :3], tip - task.chest, atol=1e-6)


def test_seeds_draw_different_starts_and_both_itches(task):
    world = task.make_world(64, threads=1)
    world.reset(np.arange(64))
    angles = world._batch.bind("qpos")[:, 10:]
    assert len(np.unique(angles, axis=0)) > 48
    assert 16 < world.itch.sum() < 48


def test_the_person_starts_seated_and_at_rest(task):
    world = task.make_world(2, threads=1)
    step = world.reset(np.arange(2))
    np.testing.assert_allclose(step.features[0, :10], human.start_angles(), rtol=1e-6)
    np.testing.assert_array_equal(step.features[:, 10:20], 0)
    np.testing.assert_array_equal(step.reward, 0)


def test_the_robot_starts_in_a_clear_pose_joint_by_joint(task):
    world = task.make_world(8, threads=1)
    world.reset(np.arange(8))
    places = [task.model.joint(name).qposadr[0] for name in jaco.JOINT_NAMES]
    for angles in world._batch.bind("qpos")[:, places]:
        assert (angles == task.starts).all(axis=1).any()


def test_the_start_poses_are_many_and_small_on_disk():
    assert STARTS.stored().shape == (COUNT, len(jaco.JOINT_NAMES))
    assert len(np.unique(STARTS.stored(), axis=0)) == COUNT
    file = resources.files("rigid.tasks.itch_scratching") / "starts.npz"
    assert len(file.read_bytes()) < 50_000


def test_starts_lie_on_one_branch():
    assert np.ptp(STARTS.stored(), axis=0).max() < 1.0


def test_inverse_kinematics_reach_a_goal_near_a_start(task):
    arm = STARTS.kinematics(task.model)
    goal = STARTS.goal + (0.03, -0.02, 0.01)
    angles = arm.solve(goal, task.starts[0])
    position, rotation = arm.pose(angles)
    np.testing.assert_allclose(position, goal, atol=0.01)
    assert (STARTS.rotation.inv() * rotation).magnitude() < np.deg2rad(1)


def test_inverse_kinematics_say_when_a_goal_is_out_of_reach(task):
    arm = STARTS.kinematics(task.model)
    assert arm.solve(np.array([5.0, 0.0, 0.8]), task.starts[0]) is None


def test_a_pose_that_touches_the_person_is_not_clear(task):
    arm = STARTS.kinematics(task.model)
    angles = arm.solve(np.array([-0.4, 0.03, 0.9]), task.starts[0])
    assert not arm.clear(angles)


@pytest.mark.slow
def test_starts_can_be_solved_again(task):
    solved = STARTS.solve(task.build_spec(), count=2, seed=1)
    arm = STARTS.kinematics(task.model)
    for angles in solved:
        position, _ = arm.pose(angles)
        assert np.abs(position - STARTS.goal).max() < STARTS.spread + 0.01
        assert arm.clear(angles)


def test_a_scene_without_clear_starts_is_refused(task, monkeypatch):
    monkeypatch.setattr(kinematics.ArmKinematics, "clear", lambda *_: False)
    with pytest.raises(UserError, match="only 0 of 256 start poses are free of collisions"):
        STARTS.clear(task.model)

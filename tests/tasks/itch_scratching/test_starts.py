"""How person and robot start, and the inverse kinematics behind it."""

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.tasks.bodies import human, kinematics, scratcher
from rigid.tasks.itch_scratching.starts import STARTS


def test_the_first_observation_shows_the_start(task, start):
    data, _, person = start
    tip = data.site(scratcher.TIP_SITE).xpos
    np.testing.assert_allclose(list(person.values())[:3], tip - task.chest, atol=1e-6)


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


def test_a_scene_without_clear_starts_is_refused(task, monkeypatch):
    monkeypatch.setattr(kinematics.ArmKinematics, "clear", lambda *_: False)
    with pytest.raises(UserError, match="only 0 of 256 start poses are free of collisions"):
        STARTS.clear(task.model)

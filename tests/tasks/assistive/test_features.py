"""Features are the human's motion: they do not show the robot, and they tell the pose."""

import numpy as np
import pytest

from rigid.tasks.protocol import DrawsFeatures
from tests.tasks.playing import at_rest, drawn


@pytest.fixture(scope="module")
def moved(task):
    """An episode of random actions: snapshots, and the features of every moment."""
    world, rng = task.make_world(1), np.random.default_rng(0)
    step = world.reset(np.array([4]))
    snapshots, features = [world.snapshot()[0]], [step.features[0]]
    for _ in range(12):
        step = world.step(*drawn(task, rng, 1))
        snapshots.append(world.snapshot()[0])
        features.append(step.features[0])
    return np.array(snapshots), np.array(features)


def test_features_do_not_show_a_robot_that_does_not_touch(task):
    worlds, rng = [task.make_world(2, threads=1) for _ in range(2)], np.random.default_rng(0)
    for world in worlds:
        world.reset(np.arange(2))
    for _ in range(5):
        robot, person = drawn(task, rng, 2)
        one = worlds[0].step(robot, person)
        other = worlds[1].step(at_rest(task, 2)[0], person)
        np.testing.assert_array_equal(one.features, other.features)


def test_features_tell_the_pose_that_the_replay_shows(case, task, moved):
    snapshots, features = moved
    assert isinstance(task, DrawsFeatures)
    shown, replayed = task.human_poses(task.feature_names, features), task.replay(snapshots)
    names = task.scene()["bodies"]
    assert tuple(names[i] for i in shown["bodies"]) == case.poses
    columns = [replayed["bodies"].index(body) for body in shown["bodies"]]
    np.testing.assert_allclose(shown["poses"], replayed["poses"][:, columns], atol=1e-5)


def test_without_one_of_the_joints_there_is_no_pose(task, moved):
    features = moved[1]
    assert task.human_poses(task.feature_names[1:], features[:, 1:]) is None


def test_features_have_units_and_angles_are_radians(task):
    assert set(task.feature_units) <= set(task.feature_names)
    joints = task.human.action_size
    assert {task.feature_units[name] for name in task.feature_names[:joints]} == {"rad"}

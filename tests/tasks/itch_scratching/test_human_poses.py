"""The human as features describe it: the arm of MuJoCo's forward kinematics, or nothing."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.naturalness.features import choose_features, seen_through
from rigid.tasks.bodies.human import ARM_JOINTS
from rigid.tasks.bodies.sizes import BODIES
from rigid.tasks.protocol import DrawsFeatures

ARM = ("right_shoulder", "right_upper_arm", "right_forearm", "right_hand")


@pytest.fixture(scope="module")
def played(task):
    """An episode of random actions: snapshots, and the features of every moment."""
    world, rng = task.make_world(1), np.random.default_rng(0)
    step = world.reset(np.array([4]))
    snapshots, features = [world.snapshot()[0]], [step.features[0]]
    for _ in range(12):
        step = world.step(rng.uniform(-1, 1, (1, 7)), rng.uniform(-1, 1, (1, 10)))
        snapshots.append(world.snapshot()[0])
        features.append(step.features[0])
    return np.array(snapshots), np.array(features)


def test_the_arm_is_where_the_replay_shows_it(task, played):
    snapshots, features = played
    shown, replayed = task.human_poses(task.feature_names, features), task.replay(snapshots)
    assert tuple(task.model.body(i).name for i in shown["bodies"]) == ARM
    columns = [replayed["bodies"].index(body) for body in shown["bodies"]]
    np.testing.assert_allclose(shown["poses"], replayed["poses"][:, columns], atol=1e-6)


def test_features_may_come_in_any_order_among_others(task, played):
    features = played[1]
    order = np.random.default_rng(1).permutation(len(task.feature_names))
    names = [task.feature_names[i] for i in order]
    np.testing.assert_array_equal(
        task.human_poses(names, features[:, order])["poses"],
        task.human_poses(task.feature_names, features)["poses"],
    )


def test_an_observation_tells_the_pose_as_well(task):
    chosen = choose_features("observation", task)
    step = seen_through(task, chosen).make_world(1).reset(np.array([4]))
    assert step.features.shape == (1, len(chosen.names))
    assert task.human_poses(chosen.names, step.features.astype(float)) is not None


@pytest.mark.parametrize("missing", ARM_JOINTS)
def test_without_one_of_the_joints_there_is_no_pose(task, missing):
    names = [name for name in task.feature_names if name != missing]
    assert task.human_poses(names, np.zeros((1, len(names)))) is None


def test_angles_beyond_a_joints_limit_are_drawn_as_they_are(task):
    names = list(ARM_JOINTS)
    bent = np.zeros((2, 10))
    bent[1, names.index("elbow")] = np.pi  # The limit is 0.
    poses = task.human_poses(names, bent)["poses"]
    upper, fore, hand = poses[:, 1:, :3].swapaxes(0, 1)
    size = BODIES["male"]
    np.testing.assert_allclose(fore[1], fore[0])
    np.testing.assert_allclose(upper - fore, [[0, 0, size.upper_arm[1]]] * 2, atol=1e-6)
    length = sum(size.forearm)
    np.testing.assert_allclose(hand[:, 2] - fore[:, 2], [-length, length], atol=1e-6)


def test_no_moments_are_no_poses(task):
    assert task.human_poses(task.feature_names, np.zeros((0, 22)))["poses"].shape == (0, 4, 7)


def test_the_task_says_that_it_draws_features(task):
    assert isinstance(task, DrawsFeatures)

"""The human as features describe it: the arm of MuJoCo's forward kinematics, or nothing."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.naturalness.features import choose_features, seen_through
from rigid.tasks.bodies.human import ARM_JOINTS
from rigid.tasks.bodies.sizes import BODIES
from tests.tasks.playing import drawn


def test_features_may_come_in_any_order_among_others(task):
    world, rng = task.make_world(3), np.random.default_rng(0)
    world.reset(np.arange(3))
    features = world.step(*drawn(task, rng, 3)).features
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

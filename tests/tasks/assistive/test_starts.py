"""The robot starts where the original's does, clear of person and furniture."""

from importlib import resources

import numpy as np
import pytest

from rigid.tasks.bodies import jaco
from rigid.tasks.physics.starts import COUNT

BODIES = [{"body": "female", "percentile": 5.0}, {"percentile": 95.0}, {"servo": "datasheet"}]


def test_start_poses_are_many_and_small_on_disk(case):
    stored = case.starts.stored()
    assert stored.shape == (COUNT, len(jaco.JOINT_NAMES))
    assert len(np.unique(stored, axis=0)) == COUNT
    file = resources.files(f"rigid.tasks.{case.folder}") / "starts.npz"
    assert len(file.read_bytes()) < 50_000


def test_a_start_is_where_the_original_begins(case, task):
    arm = case.starts.kinematics(task.model)
    for angles in task.starts[::32]:
        place, turned = arm.pose(angles)
        assert (np.abs(place - case.starts.goal) < case.starts.spread + 0.01).all()
        assert (case.starts.rotation.inv() * turned).magnitude() < np.deg2rad(1)


def test_the_robot_starts_in_a_clear_pose_joint_by_joint(task):
    world = task.make_world(8, threads=1)
    world.reset(np.arange(8))
    places = [task.model.joint(name).qposadr[0] for name in jaco.JOINT_NAMES]
    for angles in world._batch.bind("qpos")[:, places]:
        assert (angles == task.starts).all(axis=1).any()


@pytest.mark.parametrize("parameters", BODIES, ids=lambda given: "-".join(map(str, given.values())))
def test_every_body_leaves_clear_starts(task, parameters):
    assert len(task.with_parameters(**parameters).starts) >= 16


@pytest.mark.slow
def test_starts_can_be_solved_again(case, task):
    arm = case.starts.kinematics(task.model)
    for angles in case.starts.solve(task.build_spec(), count=2, seed=1):
        place, _ = arm.pose(angles)
        assert np.abs(place - case.starts.goal).max() < case.starts.spread + 0.01
        assert arm.clear(angles)

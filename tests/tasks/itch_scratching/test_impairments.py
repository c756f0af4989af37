"""Impairments change the person as they say."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bodies import human, jaco
from tests.tasks.scripted import still

ELBOW = human.ARM_JOINTS.index("elbow")
ABDUCTION = human.ARM_JOINTS.index("shoulder_x")


@pytest.fixture(scope="module")
def impaired(task):
    """The task with an impairment, at full severity unless stated."""
    return lambda kind, severity=1.0: task.with_parameters(impairment=kind, severity=severity)


def arm_motion(task, action, steps):
    """Arm angles of one world from the start on, shape (steps + 1, 10)."""
    world = task.make_world(1, threads=1)
    angles = [world.reset(np.array([3])).features[0, :10]]
    for _ in range(steps):
        step = world.step(np.zeros((1, 7)), action[None])
        angles.append(step.features[0, :10])
    return np.array(angles, dtype=np.float64)


def raised():
    """Abduct the arm and straighten the elbow."""
    action = np.zeros(10)
    action[[ABDUCTION, ELBOW]] = 1
    return action


def ranges(task):
    return np.array([task.model.joint(name).range for name in human.ARM_JOINTS])


def test_limits_halve_the_range_but_leave_the_seated_pose_possible(task, impaired):
    narrow, wide = ranges(impaired("limits")), ranges(task)
    start = human.start_angles()
    np.testing.assert_allclose(narrow[:, 0], np.minimum(wide[:, 0] / 2, start))
    np.testing.assert_allclose(narrow[:, 1], np.maximum(wide[:, 1] / 2, start))


def test_limits_stop_the_arm_earlier(task, impaired):
    action = np.zeros(10)
    action[human.ARM_JOINTS.index("wrist_x")] = 1
    free, stopped = (arm_motion(which, action, 25)[-1, 8] for which in (task, impaired("limits")))
    assert stopped == pytest.approx(np.deg2rad(45), abs=0.05)
    assert free > stopped + 0.3


def test_limits_leave_the_robot_alone(task, impaired):
    for name in jaco.JOINT_NAMES:
        expected = task.model.joint(name).range
        np.testing.assert_array_equal(impaired("limits").model.joint(name).range, expected)


def test_weakness_makes_an_active_person_start_slower(task, impaired):
    strong, weak = (
        np.diff(arm_motion(t, raised(), 3), axis=0) for t in (task, impaired("weakness"))
    )
    assert (weak[0, [ABDUCTION, ELBOW]] < 0.6 * strong[0, [ABDUCTION, ELBOW]]).all()
    assert (weak[0, [ABDUCTION, ELBOW]] > 0).all()


def test_weakness_quarters_the_torque_of_the_person_and_not_of_the_robot(impaired):
    model = impaired("weakness").model
    for name in human.ARM_JOINTS:
        np.testing.assert_allclose(model.actuator(f"{name}_servo").forcerange, (-0.25, 0.25))
    for name in jaco.JOINT_NAMES:
        np.testing.assert_allclose(model.actuator(f"{name}_servo").forcerange, (-1, 1))


def test_tremor_moves_a_passive_person_to_and_fro(task, impaired):
    calm = np.diff(arm_motion(task, np.zeros(10), 20), axis=0)
    shaking = np.diff(arm_motion(impaired("tremor"), np.zeros(10), 20), axis=0)
    np.testing.assert_array_equal(calm, 0)
    moved = np.abs(shaking[5:]).max(axis=0) > 1e-3
    assert moved.sum() >= 8
    turns = np.sign(shaking[5:-1, moved]) != np.sign(shaking[6:, moved])
    assert turns.mean() > 0.9


def test_less_severe_is_less(impaired):
    def shaken(severity):
        angles = arm_motion(impaired("tremor", severity), np.zeros(10), 10)
        return np.abs(np.diff(angles, axis=0)).mean()

    assert 0 < shaken(0.3) < 0.6 * shaken(1.0)
    assert impaired("weakness", 0.5).parameters.strength == pytest.approx(0.625)
    assert impaired("limits", 0.0).parameters.limit_scale == 1


def test_tremor_is_drawn_from_the_seed(impaired):
    world = impaired("tremor").make_world(2, threads=1)
    world.reset(np.array([1, 2]))
    shaken = [world.step(*still(2)).features[:, :10] for _ in range(3)][-1]
    assert np.abs(shaken[0] - shaken[1]).max() > 1e-3


def test_every_impaired_scene_compiles_to_the_same_layout(task, impaired):
    for kind in ("limits", "weakness", "tremor"):
        model = impaired(kind).model
        assert isinstance(model, mujoco.MjModel)
        assert (model.nq, model.nsensordata) == (task.model.nq, task.model.nsensordata)

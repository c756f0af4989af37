"""Every joint is a velocity servo like the original's: 0.566 rad/s at full action, 1 N·m."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bodies import human, jaco
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.scene import build_spec
from rigid.tasks.physics.stepping import TARGET_AHEAD
from tests.tasks.scripted import posed

JOINTS = human.ARM_JOINTS + jaco.JOINT_NAMES
SPEED = 0.566  # [rad/s], measured on the original at a held full action.


@pytest.fixture(scope="module")
def held(task):
    """Speed [rad/s] and torque [N·m] of each joint alone, held at ±1 for 2 s from its middle.

    Limits and contacts are off, since some ranges are shorter than 2 s at full speed; the other
    joints are too heavy to move and stand as at the start of an episode.
    """
    spec = build_spec(ItchScratchingParameters())
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
    model = spec.compile()
    start, light = posed(task).qpos, model.dof_armature.copy()
    results = {}
    for name in JOINTS:
        joint = model.joint(name).id
        model.dof_armature[:] = 1e6
        model.dof_armature[joint] = light[joint]
        for sign in (1, -1):
            results[name, sign] = _hold(model, start, joint, sign)
    return results


def _hold(model, start, joint, sign):
    data = mujoco.MjData(model)
    data.qpos[:] = start
    data.qpos[joint] = model.jnt_range[joint].mean()
    angles, torques = [data.qpos[joint]], []
    for _ in range(20):
        data.ctrl[:] = data.qpos
        data.ctrl[joint] += sign * TARGET_AHEAD
        for _ in range(5):
            mujoco.mj_step(model, data)
            torques.append(data.actuator_force[joint])
        angles.append(data.qpos[joint])
    return sign * np.diff(angles) / 0.1, np.array(torques)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("joint", JOINTS)
def test_a_held_full_action_turns_at_the_speed_of_the_original(held, joint, sign):
    speed, _ = held[joint, sign]
    np.testing.assert_allclose(speed[-5:], SPEED, rtol=0.03)


@pytest.mark.parametrize("joint", JOINTS)
def test_a_turning_joint_does_not_ripple(held, joint):
    speed, _ = held[joint, 1]
    assert np.ptp(speed[-5:]) < 0.02 * SPEED


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("joint", JOINTS)
def test_torque_saturates_at_one_newton_metre(held, joint, sign):
    _, torque = held[joint, sign]
    assert np.abs(torque).max() == 1.0


def test_light_joints_carry_enough_armature_not_to_swing(task):
    assert task.model.dof_armature.min() >= 0.03


@pytest.mark.parametrize("joint", ["jaco_joint_1", "jaco_joint_2"])
def test_the_heaviest_joints_start_as_slowly_as_in_the_original(held, joint):
    speed, _ = held[joint, 1]
    assert 0.1 * speed[0] == pytest.approx(0.008, abs=0.002)  # [rad] in the first step.


def test_the_datasheet_profile_is_stronger_than_the_paper_profile():
    paper, datasheet = jaco.robot_servo("paper"), jaco.robot_servo("datasheet")

    def most(servo):
        return min(jaco.Servo.RATE * servo.gain * TARGET_AHEAD, servo.torque_caps[0])

    assert most(datasheet) > 2 * most(paper)

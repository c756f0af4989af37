"""Every joint is a servo half as fast as itch scratching's: 0.297 rad/s at full action, 1 N·m."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bodies import head, jaco
from rigid.tasks.feeding.parameters import FeedingParameters
from rigid.tasks.feeding.scene import RATE, build_spec
from rigid.tasks.physics.stepping import TARGET_AHEAD

JOINTS = head.HEAD_JOINTS + jaco.JOINT_NAMES
SPEED = 0.25 * (1 - 0.975**5) / 0.1  # [rad/s]: the error shrinks by 2.5 % at each physics step.


@pytest.fixture(scope="module")
def model():
    """Without limits and contacts: some ranges are shorter than 2 s at full speed."""
    spec = build_spec(FeedingParameters())
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
    return spec.compile()


@pytest.mark.parametrize("name", JOINTS)
def test_a_held_full_action_turns_at_the_speed_of_the_original(task, model, name):
    data, joint, light = mujoco.MjData(model), model.joint(name).id, model.dof_armature.copy()
    data.qpos[[model.joint(n).qposadr[0] for n in jaco.JOINT_NAMES]] = task.starts[0]
    model.dof_armature[:] = 1e6  # The other joints stand still.
    model.dof_armature[joint] = light[joint]
    angles, torques = [data.qpos[joint]], []
    for _ in range(40):
        data.ctrl[:] = data.qpos
        data.ctrl[joint] += TARGET_AHEAD
        for _ in range(5):
            mujoco.mj_step(model, data)
            torques.append(data.actuator_force[joint])
        angles.append(data.qpos[joint])
    model.dof_armature[:] = light
    speed = np.diff(angles)[-5:] / 0.1  # The heaviest take 3 s to reach it.
    np.testing.assert_allclose(speed, SPEED, rtol=0.03)
    assert np.ptp(speed) < 0.02 * SPEED
    assert np.abs(torques).max() <= 1.0


def test_the_servo_is_the_original_motor_gain_over_its_time_step():
    assert pytest.approx(0.025 / 0.02) == RATE

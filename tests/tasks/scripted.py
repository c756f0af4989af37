"""A scripted robot that scratches a known spot: real contacts without any training."""

import mujoco
import numpy as np

from rigid.tasks.bodies import human, jaco, scratcher
from rigid.tasks.itch_scratching.scene import LIMBS

FULL_ACTION = 0.0566  # [rad] that a held full action moves a joint in a control step.
PRESS = 0.01  # [m] that the tip aims below the skin.
STROKE = 0.03  # [m] that it swings to either side, along the limb.


class Scratcher:
    """Drives the tip to and fro over one itch point in every world by damped least squares."""

    def __init__(self, task, world):
        self._model, self._world = task.model, world
        self._data = mujoco.MjData(task.model)
        self._joints = [task.model.joint(name).qposadr[0] for name in jaco.JOINT_NAMES]
        self._tip = task.model.site(scratcher.TIP_SITE).id
        self._time = 0

    def act(self, limbs):
        """Robot actions, shape (B, 7); `limbs` indexes LIMBS in each world."""
        self._time += 1
        angles = self._world._batch.bind("qpos")
        return np.array([self._one(*row) for row in zip(angles, limbs, strict=True)])

    def _one(self, angles, limb):
        data, jacobian = self._data, np.zeros((3, self._model.nv))
        data.qpos[:] = angles
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_comPos(self._model, data)
        mujoco.mj_jacSite(self._model, data, jacobian, None, self._tip)
        itch = data.site(f"itch_{LIMBS[limb]}")
        outward, _, along = itch.xmat.reshape(3, 3).T * ((-1,), (1,), (1,))
        swing = STROKE * np.sin(1.2 * self._time)
        goal = itch.xpos + (0.01 - PRESS) * outward + swing * along
        columns = jacobian[:, self._joints]
        square = columns @ columns.T + 1e-3 * np.eye(3)
        turn = columns.T @ np.linalg.solve(square, goal - data.site_xpos[self._tip])
        return np.clip(turn / FULL_ACTION, -1, 1)


def posed(task, start=0):
    """MjData of the task's scene with the person seated and the robot at one of its starts."""
    data = mujoco.MjData(task.model)
    for name, angle in zip(human.ARM_JOINTS, human.start_angles(), strict=True):
        data.joint(name).qpos = angle
    for name, angle in zip(jaco.JOINT_NAMES, task.starts[start], strict=True):
        data.joint(name).qpos = angle
    mujoco.mj_forward(task.model, data)
    return data


def still(batch):
    """Zero actions of robot and human."""
    return np.zeros((batch, 7)), np.zeros((batch, 10))


def random_actions(rng, batch):
    """Uniform actions of robot and human."""
    return rng.uniform(-1, 1, (batch, 7)), rng.uniform(-1, 1, (batch, 10))

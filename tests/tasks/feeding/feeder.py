"""A scripted robot that feeds by what it observes: proof that the task can be done."""

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import jaco, spoon, wheelchair
from rigid.tasks.feeding.food import PIECES
from rigid.tasks.feeding.observation import ROBOT_NAMES
from rigid.tasks.registry import make_task

FULL_ACTION = 0.0297  # [rad] that a held full action moves a joint in a control step.
SPEED, TURN = 0.012, 0.05  # [m] and [rad] of the spoon in a control step.
BEFORE, ALIGNED = 0.07, 0.015  # [m], where it waits before the mouth until it is in line.


def _columns(first, count):
    start = ROBOT_NAMES.index(first)
    return slice(start, start + count)


JOINTS = _columns(jaco.JOINT_NAMES[0], 7)
TO_MOUTH = _columns("spoon_to_mouth_x", 3)
HEAD = _columns("head_quaternion_w", 4)


class Feeder:
    """Brings the food in front of the mouth, then in, by damped least squares; keeps it level."""

    observation_size, action_size = len(ROBOT_NAMES), len(jaco.JOINT_NAMES)

    def __init__(self, task):
        self._model, self._data = task.model, mujoco.MjData(task.model)
        self._joints = [task.model.joint(name).qposadr[0] for name in jaco.JOINT_NAMES]
        self._site = task.model.site(spoon.SPOON_SITE).id
        self._base = Rotation.from_euler("z", wheelchair.JACO_YAW)

    def initial_state(self, batch):
        del batch
        return ()

    def act(self, observation, state, rng):
        del rng
        return np.array([self._one(row) for row in observation]), state

    def _one(self, seen):
        data, jacobian = self._data, np.zeros((6, self._model.nv))
        data.qpos[self._joints] = seen[JOINTS]
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_comPos(self._model, data)
        mujoco.mj_jacSite(self._model, data, jacobian[:3], jacobian[3:], self._site)
        turned = data.site_xmat[self._site].reshape(3, 3)
        place = data.site_xpos[self._site]
        mouth = place - self._base.apply(seen[TO_MOUTH])
        head = self._base * Rotation.from_quat(seen[HEAD], scalar_first=True)
        front = head.apply((0, -1, 0)) * (1, 1, 0)
        front /= np.linalg.norm(front)
        food = place + turned @ PIECES.mean(axis=0)
        off = (food - mouth) - (food - mouth) @ front * front
        goal = mouth + (BEFORE if np.linalg.norm(off) > ALIGNED else 0.0) * front
        wanted = np.stack([np.cross((0, 0, 1.0), front), (0, 0, 1.0), front], axis=1)
        turn = Rotation.from_matrix(wanted @ turned.T).as_rotvec()
        jacobian[3:] *= 0.3  # [m]: how much a turn counts.
        error = np.concatenate([_at_most(goal - food, SPEED), 0.3 * _at_most(turn, TURN)])
        columns = jacobian[:, self._joints]
        square = columns @ columns.T + 1e-4 * np.eye(6)
        action = columns.T @ np.linalg.solve(square, error) / FULL_ACTION
        return action / max(1.0, np.abs(action).max())


def _at_most(vector, length):
    return vector * min(1.0, length / max(np.linalg.norm(vector), 1e-9))


def feeder():
    """For `--robot python:tests.tasks.feeding.feeder:feeder`."""
    return Feeder(make_task("feeding"))

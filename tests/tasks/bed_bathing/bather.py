"""A scripted robot that wipes an arm by what it observes: proof that the task can be done."""

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rigid.tasks.bed_bathing.observation import ROBOT_NAMES
from rigid.tasks.bodies import bed, jaco, wiper
from rigid.tasks.registry import make_task

FULL_ACTION = 0.0566  # [rad] that a held full action moves a joint in a control step.
SPEED, TURN = 0.03, 0.12  # [m] and [rad] of the pad in a control step.
PACE = 0.016  # [m] that the place to wipe goes along the arm in a control step.
NEAR, TOUCH = 0.05, 0.03  # [m]: it waits for a pad that is farther behind, and at each turn.
ABOVE, SIDE = 0.015, 0.01  # [m] that the pad aims into the skin, from above and from the side.
TILT = 0.3  # [rad] of the pad towards the robot, on the way down the arm.
SITE = 0.0025  # [m] from the pad's underside to its site.
FIRST, LAST = 0.2, 0.95  # Shares of the way from shoulder to wrist.

_DOWN_THE_BED = np.array([0.0, -1.0, 0.0])


def _columns(first, count):
    start = ROBOT_NAMES.index(first)
    return slice(start, start + count)


JOINTS = _columns(jaco.JOINT_NAMES[0], 7)
ARM = _columns("shoulder_position_x", 9)


class Bather:
    """Wipes down the arm from above, and up again from the side with the pad's front.

    Damped least squares; its state is how far along this way it is in each world [m].
    """

    observation_size, action_size = len(ROBOT_NAMES), len(jaco.JOINT_NAMES)

    def __init__(self, task):
        self._model, self._data = task.model, mujoco.MjData(task.model)
        self._joints = [task.model.joint(name).qposadr[0] for name in jaco.JOINT_NAMES]
        self._site = task.model.site(wiper.PAD_SITE).id
        size = task.parameters.body_size
        self._radii = size.upper_arm[0], size.forearm[0]

    def initial_state(self, batch):
        return np.zeros(batch)

    def act(self, observation, state, rng):
        del rng
        rows = [self._one(*row) for row in zip(observation, state, strict=True)]
        return np.array([action for action, _ in rows]), np.array([gone for _, gone in rows])

    def _one(self, seen, gone):
        data, jacobian = self._data, np.zeros((6, self._model.nv))
        data.qpos[self._joints] = seen[JOINTS]
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_comPos(self._model, data)
        mujoco.mj_jacSite(self._model, data, jacobian[:3], jacobian[3:], self._site)
        place, turned = data.site_xpos[self._site], data.site_xmat[self._site].reshape(3, 3)
        goal, wanted, near = self._goal(seen[ARM].reshape(3, 3) + np.array(bed.JACO_STAND), gone)
        jacobian[3:] *= 0.1  # [m]: how much a turn counts.
        turn = Rotation.from_matrix(wanted @ turned.T).as_rotvec()
        error = np.concatenate([_at_most(goal - place, SPEED), 0.1 * _at_most(turn, TURN)])
        columns = jacobian[:, self._joints]
        square = columns @ columns.T + 1e-4 * np.eye(6)
        action = columns.T @ np.linalg.solve(square, error) / FULL_ACTION
        follows = np.linalg.norm(goal - place) < near
        return action / max(1.0, np.abs(action).max()), gone + PACE * follows

    def _goal(self, arm, gone):
        """Where the pad shall be [m], how it shall be turned, and how near is near enough [m]."""
        lengths = np.linalg.norm(np.diff(arm, axis=0), axis=1)
        low, high = FIRST * lengths.sum(), LAST * lengths.sum()
        back = gone > high - low
        along = np.clip(2 * high - low - gone if back else low + gone, low, high)
        limb = int(along > lengths[0])
        # An arm without length is only seen where a policy is tried out on zeros.
        axis = (arm[limb + 1] - arm[limb]) / lengths[limb] if lengths[limb] else _DOWN_THE_BED
        up = np.array([0, 0, 1.0]) - axis[2] * axis
        up /= np.linalg.norm(up)
        side = np.cross(axis, up)
        on_axis, radius = arm[limb] + (along - limb * lengths[0]) * axis, self._radii[limb]
        if back:
            outward = up
            goal = on_axis + (radius + wiper.PAD_HALF[0] - SIDE) * side
        else:
            outward = np.cos(TILT) * up + np.sin(TILT) * side
            goal = on_axis + (radius + SITE - ABOVE) * outward
        across = np.cross(outward, axis)
        wanted = np.stack([across, np.cross(outward, across), outward], axis=1)
        turning = along in (low, high) or abs(gone - (high - low)) < 2 * PACE
        return goal, wanted, TOUCH if turning else NEAR


def _at_most(vector, length):
    return vector * min(1.0, length / max(np.linalg.norm(vector), 1e-9))


def bather():
    """For `--robot python:tests.tasks.bed_bathing.bather:bather`."""
    return Bather(make_task("bed-bathing"))

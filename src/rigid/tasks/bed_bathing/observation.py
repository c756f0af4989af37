"""What robot and human see: Assistive Gym's vectors. Nobody sees which points are left."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bed_bathing.sensing import Poses
from rigid.tasks.bodies import bed, human, jaco, lying
from rigid.tasks.physics.observing import frame, joined, points, seen_by_robot, turned_for_robot

_PAD = frame("pad")
ARM_NAMES = points("shoulder_position", "elbow_position", "wrist_position")
"""What both see of the human's arm [m]."""
ROBOT_NAMES = (*_PAD, *jaco.JOINT_NAMES, *ARM_NAMES, "tool_force")
HUMAN_NAMES = (*_PAD, *human.ARM_JOINTS, *ARM_NAMES, "force_on_person", "pad_force")

_CHEST_FROM_WORLD = lying.LAID_DOWN.inv()


def observe(
    poses: Poses,
    robot_angles: Float[np.ndarray, "B 7"],
    human_angles: Float[np.ndarray, "B 10"],
    forces: Float[np.ndarray, "B 3"],
    chest: Float[np.ndarray, "3"],
) -> tuple[Float[np.ndarray, "B r"], Float[np.ndarray, "B h"]]:
    """Returns the robot's and the human's observation, float32.

    The robot sees in its base frame, the human in the frame of the chest, which lies on its back.

    Args:
        poses: Where things are, world frame.
        robot_angles: Jaco joints [rad].
        human_angles: Arm joints [rad].
        forces: Wiper on anything, robot on person, pad on the arm [N].
        chest: Origin of the human's frame [m].
    """
    batch = len(poses.pad)
    places = np.concatenate([poses.pad[:, None], poses.arm], axis=1)  # [B, 4, 3]
    seen = seen_by_robot(places, bed.JACO_STAND, bed.JACO_YAW)
    felt = np.matmul(places - chest, _CHEST_FROM_WORLD.as_matrix().T)
    turned = _CHEST_FROM_WORLD * Rotation.from_quat(poses.pad_quaternion, scalar_first=True)
    robot = [
        seen[:, 0], turned_for_robot(poses.pad_quaternion, bed.JACO_YAW), robot_angles,
        seen[:, 1:].reshape(batch, 9), forces[:, :1],
    ]  # fmt: skip
    person = [
        felt[:, 0], turned.as_quat(scalar_first=True), human_angles,
        felt[:, 1:].reshape(batch, 9), forces[:, 1:],
    ]  # fmt: skip
    return joined(robot), joined(person)

"""What robot and human see: Assistive Gym's vectors, the mouth among what the robot sees."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import head, jaco
from rigid.tasks.feeding.sensing import Poses
from rigid.tasks.physics.observing import frame, joined, points, seen_by_robot, turned_for_robot

_SPOON = (*frame("spoon"), *points("spoon_to_mouth"))
HEAD_NAMES = frame("head")
"""What both see of the human: where the head is, and how it is turned."""
ROBOT_NAMES = (*_SPOON, *jaco.JOINT_NAMES, *HEAD_NAMES, "spoon_force")
HUMAN_NAMES = (*_SPOON, *head.HEAD_JOINTS, *HEAD_NAMES, "robot_force", "spoon_force")


def observe(
    poses: Poses,
    robot_angles: Float[np.ndarray, "B 7"],
    head_angles: Float[np.ndarray, "B 4"],
    forces: Float[np.ndarray, "B 2"],
    chest: Float[np.ndarray, "3"],
) -> tuple[Float[np.ndarray, "B r"], Float[np.ndarray, "B h"]]:
    """Returns the robot's and the human's observation, float32.

    The robot sees in its base frame, the human in the chest frame.

    Args:
        poses: Where things are, world frame.
        robot_angles: Jaco joints [rad].
        head_angles: Neck and head [rad].
        forces: Robot without spoon, and spoon, on the person [N].
        chest: Origin of the human's frame [m].
    """
    places = np.stack([poses.spoon, poses.mouth, poses.head], axis=1)  # [B, 3, 3]
    seen, felt = seen_by_robot(places), places - chest
    robot = [
        seen[:, 0], turned_for_robot(poses.spoon_quaternion), seen[:, 0] - seen[:, 1], robot_angles,
        seen[:, 2], turned_for_robot(poses.head_quaternion), forces[:, 1:],
    ]  # fmt: skip
    person = [
        felt[:, 0], poses.spoon_quaternion, felt[:, 0] - felt[:, 1], head_angles, felt[:, 2],
        poses.head_quaternion, forces,
    ]  # fmt: skip
    return joined(robot), joined(person)

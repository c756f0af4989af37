"""What robot and human see (Assistive Gym's vectors, with the itch hidden from the robot)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import human, jaco
from rigid.tasks.itch_scratching.sensing import Poses
from rigid.tasks.physics.observing import frame, joined, points, seen_by_robot, turned_for_robot

_TIP = frame("tip")
_TARGET = points("tip_to_itch", "itch")
ARM_NAMES = points("shoulder_position", "elbow_position", "wrist_position")
"""What both see of the human's arm [m]."""
ROBOT_NAMES = (*_TIP, *jaco.JOINT_NAMES, *ARM_NAMES, "tool_force")
ROBOT_SEEING_NAMES = (*ROBOT_NAMES, *_TARGET)
HUMAN_NAMES = (*_TIP, *_TARGET, *human.ARM_JOINTS, *ARM_NAMES, "force_on_person", "force_at_itch")


def observe(
    poses: Poses,
    itch: Float[np.ndarray, "B 3"],
    robot_angles: Float[np.ndarray, "B 7"],
    human_angles: Float[np.ndarray, "B 10"],
    forces: Float[np.ndarray, "B 3"],
    chest: Float[np.ndarray, "3"],
    *,
    itch_visible: bool,
) -> tuple[Float[np.ndarray, "B r"], Float[np.ndarray, "B h"]]:
    """Returns the robot's and the human's observation, float32.

    Positions of the robot are in its base frame, those of the human in the chest frame.

    Args:
        poses: Where things are, world frame.
        itch: The itch point [m], world frame.
        robot_angles: Jaco joints [rad].
        human_angles: Arm joints [rad].
        forces: Tool on anything, robot on person, tool at the itch [N].
        chest: Origin of the human's frame [m].
        itch_visible: Append the itch to the robot's observation (co-optimisation only).
    """
    batch = len(itch)
    places = np.concatenate(
        [poses.tip[:, None], poses.arm, itch[:, None]], axis=1
    )  # [B, 5, 3]: tip, shoulder, elbow, wrist, itch.
    seen, felt = seen_by_robot(places), places - chest
    robot = [
        seen[:, 0], turned_for_robot(poses.tip_quaternion), robot_angles,
        seen[:, 1:4].reshape(batch, 9), forces[:, :1],
    ]  # fmt: skip
    if itch_visible:
        robot += [seen[:, 0] - seen[:, 4], seen[:, 4]]
    person = [
        felt[:, 0], poses.tip_quaternion, felt[:, 0] - felt[:, 4], felt[:, 4], human_angles,
        felt[:, 1:4].reshape(batch, 9), forces[:, 1:],
    ]  # fmt: skip
    return joined(robot), joined(person)

"""What robot and human see (Assistive Gym's vectors, with the itch hidden from the robot)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import human, jaco, wheelchair
from rigid.tasks.itch_scratching.sensing import Poses

_AXES = ("x", "y", "z")
_REACH = 3.0  # [m], ours: no point of the scene is further from either frame.
_FORCE = 1000.0  # [N], ours: bound of the observed forces.
_ROBOT_FROM_WORLD = Rotation.from_euler("z", wheelchair.JACO_YAW).inv()


def _points(*names: str) -> list[str]:
    return [f"{name}_{axis}" for name in names for axis in _AXES]


_TIP = [*_points("tip"), *(f"tip_quaternion_{axis}" for axis in ("w", *_AXES))]
_TARGET = _points("tip_to_itch", "itch")
ARM_NAMES = tuple(_points("shoulder_position", "elbow_position", "wrist_position"))
"""What both see of the human's arm [m]."""
ROBOT_NAMES = (*_TIP, *jaco.JOINT_NAMES, *ARM_NAMES, "tool_force")
ROBOT_SEEING_NAMES = (*ROBOT_NAMES, *_TARGET)
HUMAN_NAMES = (*_TIP, *_TARGET, *human.ARM_JOINTS, *ARM_NAMES, "force_on_person", "force_at_itch")


def bounds(names: tuple[str, ...], robot_limits: np.ndarray, arm_limits: np.ndarray) -> np.ndarray:
    """Finite (low, high) of each observed number, shape (n, 2)."""
    angles = dict(zip((*jaco.JOINT_NAMES, *human.ARM_JOINTS), [*robot_limits, *arm_limits],
                      strict=True))  # fmt: skip
    slack = 0.2  # [rad]: limits are soft in MuJoCo.
    rows = []
    for name in names:
        if name in angles:
            rows.append(angles[name] + np.array([-slack, slack]))
        elif name.startswith("tip_quaternion"):
            rows.append(np.array([-1.0, 1.0]))
        elif "force" in name:
            rows.append(np.array([0.0, _FORCE]))
        else:
            rows.append(np.array([-_REACH, _REACH]))
    return np.array(rows)


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
    points = np.concatenate(
        [poses.tip[:, None], poses.arm, itch[:, None]], axis=1
    )  # [B, 5, 3]: tip, shoulder, elbow, wrist, itch.
    seen = np.matmul(points - np.array(wheelchair.JACO_MOUNT), _ROBOT_FROM_WORLD.as_matrix().T)
    turned = Rotation.from_quat(poses.tip_quaternion, scalar_first=True)
    quaternion = (_ROBOT_FROM_WORLD * turned).as_quat(scalar_first=True)
    robot = [seen[:, 0], quaternion, robot_angles, seen[:, 1:4].reshape(batch, 9)]
    robot.append(forces[:, :1])
    if itch_visible:
        robot += [seen[:, 0] - seen[:, 4], seen[:, 4]]
    felt = points - chest
    person = [
        felt[:, 0], poses.tip_quaternion, felt[:, 0] - felt[:, 4], felt[:, 4], human_angles,
        felt[:, 1:4].reshape(batch, 9), forces[:, 1:],
    ]  # fmt: skip
    return (
        np.concatenate(robot, axis=1).astype(np.float32),
        np.concatenate(person, axis=1).astype(np.float32),
    )

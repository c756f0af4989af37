"""What robot and human see: Assistive Gym's vectors, the mouth among what the robot sees."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import head, jaco, wheelchair
from rigid.tasks.feeding.sensing import Poses

_AXES = ("x", "y", "z")
_REACH = 3.0  # [m], ours: no point of the scene is further from either frame.
_FORCE = 1000.0  # [N], ours: bound of the observed forces.
_SLACK = 0.2  # [rad], ours: limits are soft in MuJoCo.
_ROBOT_FROM_WORLD = Rotation.from_euler("z", wheelchair.JACO_YAW).inv()


def _point(name: str) -> list[str]:
    return [f"{name}_{axis}" for axis in _AXES]


def _frame(name: str) -> list[str]:
    return [*_point(name), *(f"{name}_quaternion_{axis}" for axis in ("w", *_AXES))]


_SPOON = (*_frame("spoon"), *_point("spoon_to_mouth"))
HEAD_NAMES = tuple(_frame("head"))
"""What both see of the human: where the head is, and how it is turned."""
ROBOT_NAMES = (*_SPOON, *jaco.JOINT_NAMES, *HEAD_NAMES, "spoon_force")
HUMAN_NAMES = (*_SPOON, *head.HEAD_JOINTS, *HEAD_NAMES, "robot_force", "spoon_force")


def bounds(
    names: tuple[str, ...], limits: dict[str, Float[np.ndarray, "2"]]
) -> Float[np.ndarray, "n 2"]:
    """Finite (low, high) of each observed number; `limits` are those of joints [rad] by name."""
    rows = []
    for name in names:
        if name in limits:
            rows.append(limits[name] + np.array([-_SLACK, _SLACK]))
        elif "quaternion" in name:
            rows.append(np.array([-1.0, 1.0]))
        elif "force" in name:
            rows.append(np.array([0.0, _FORCE]))
        else:
            rows.append(np.array([-_REACH, _REACH]))
    return np.array(rows)


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
    points = np.stack([poses.spoon, poses.mouth, poses.head], axis=1)  # [B, 3, 3]
    seen = np.matmul(points - np.array(wheelchair.JACO_MOUNT), _ROBOT_FROM_WORLD.as_matrix().T)
    spoon, turned = _seen_turned(poses.spoon_quaternion), _seen_turned(poses.head_quaternion)
    robot = [
        seen[:, 0], spoon, seen[:, 0] - seen[:, 1], robot_angles, seen[:, 2], turned, forces[:, 1:],
    ]  # fmt: skip
    felt = points - chest
    person = [
        felt[:, 0], poses.spoon_quaternion, felt[:, 0] - felt[:, 1], head_angles, felt[:, 2],
        poses.head_quaternion, forces,
    ]  # fmt: skip
    return (
        np.concatenate(robot, axis=1).astype(np.float32),
        np.concatenate(person, axis=1).astype(np.float32),
    )


def _seen_turned(quaternion: Float[np.ndarray, "B 4"]) -> Float[np.ndarray, "B 4"]:
    """A turn in the world as the robot sees it."""
    turned = _ROBOT_FROM_WORLD * Rotation.from_quat(quaternion, scalar_first=True)
    return turned.as_quat(scalar_first=True)

"""What tasks share of what robot and human see: names, bounds, and the robot's base frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import wheelchair

_AXES = ("x", "y", "z")
_REACH = 3.0  # [m], ours: no point of the scenes is further from either frame.
_FORCE = 1000.0  # [N], ours: bound of the observed forces.
_SLACK = 0.2  # [rad], ours: limits are soft in MuJoCo.


def points(*names: str) -> tuple[str, ...]:
    """Names of the coordinates of points."""
    return tuple(f"{name}_{axis}" for name in names for axis in _AXES)


def frame(name: str) -> tuple[str, ...]:
    """Names of the coordinates of a frame: its origin, then its quaternion."""
    return (*points(name), *(f"{name}_quaternion_{axis}" for axis in ("w", *_AXES)))


def bounds(
    names: Sequence[str], limits: Mapping[str, Float[np.ndarray, "2"]]
) -> Float[np.ndarray, "n 2"]:
    """Finite (low, high) of each observed number.

    Args:
        names: Of the numbers: joints, and what `points` and `frame` name; forces say so.
        limits: Of the joints [rad], by name.
    """
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


def seen_by_robot(
    places: Float[np.ndarray, "B n 3"],
    base: tuple[float, float, float] = wheelchair.JACO_MOUNT,
    yaw: float = wheelchair.JACO_YAW,
) -> Float[np.ndarray, "B n 3"]:
    """Places in the world [m] as the robot sees them: in its base frame.

    Args:
        places: World frame [m].
        base: Where the robot's base stands [m].
        yaw: How far it is turned [rad].
    """
    seen: np.ndarray = np.matmul(places - np.array(base), _from_world(yaw).as_matrix().T)
    return seen


def turned_for_robot(
    quaternion: Float[np.ndarray, "B 4"], yaw: float = wheelchair.JACO_YAW
) -> Float[np.ndarray, "B 4"]:
    """Turns in the world, w, x, y, z, as a robot sees them whose base is turned by `yaw` [rad]."""
    turned = _from_world(yaw) * Rotation.from_quat(quaternion, scalar_first=True)
    return turned.as_quat(scalar_first=True)


@cache  # Asked for twice in every control step, and SciPy takes long to make one.
def _from_world(yaw: float) -> Rotation:
    return Rotation.from_euler("z", yaw).inv()


def joined(parts: Sequence[np.ndarray]) -> Float[np.ndarray, "B n"]:
    """Parts [B, n_i] of an observation side by side, float32."""
    return np.concatenate(parts, axis=1).astype(np.float32)

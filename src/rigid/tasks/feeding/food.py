"""Food on a spoon, by rule: it lies still, falls off when the spoon tilts, and reaches the mouth.

The original puts 8 loose spheres of 5 mm radius and 1 g into a concave mesh of 64 hulls. They
would add 48 degrees of freedom to 11, and change nothing else in the scene. Here each
piece keeps the place in the spoon where it came to rest, and leaves it for good when the angle
between the spoon and the pull of gravity and acceleration is too large. Places and angles were
measured on such spheres in the original's spoon (`docs/feeding.md`).
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from jaxtyping import Bool, Float, Int

PIECES = 1e-3 * np.array([
    (-12, 15, 6), (11, 15, 3), (-5, 12, 12), (4, 12, -12),
    (-5, 11, -7), (4, 10, 8), (-5, 10, 2), (4, 9, -2),
])  # fmt: skip
"""Where the pieces lie in the spoon's frame [m], the highest first."""
SPILL_TILT = np.deg2rad([27.0, 32.0, 33.0, 35.0, 37.0, 38.0, 42.0, 46.0])
"""Tilt from which each piece falls [rad], the highest first."""
RADIUS = 0.005
"""Of a piece [m] (Assistive Gym)."""
EATEN_WITHIN = 0.03
"""A piece so near the mouth's target is eaten [m] (Assistive Gym)."""
EATEN_SHARE = 0.75
"""Share of the pieces that makes a success (Assistive Gym)."""
ENOUGH = int(np.ceil(EATEN_SHARE * len(PIECES)))
GRAVITY = 9.81
"""[m/s²]"""


class Piece(IntEnum):
    """Where a piece of food is."""

    HELD = 0
    EATEN = 1
    SPILLED = 2


def places(
    spoon: Float[np.ndarray, "*B 3"], quaternion: Float[np.ndarray, "*B 4"]
) -> Float[np.ndarray, "*B 8 3"]:
    """Where the pieces on a spoon are [m], world frame.

    Args:
        spoon: Origin of the spoon [m].
        quaternion: Of the spoon, w, x, y, z.
    """
    where: np.ndarray = spoon[..., None, :] + PIECES @ np.swapaxes(matrices(quaternion), -1, -2)
    return where


def matrices(quaternion: Float[np.ndarray, "*B 4"]) -> Float[np.ndarray, "*B 3 3"]:
    """Rotation matrices of unit quaternions w, x, y, z."""
    w, x, y, z = np.moveaxis(quaternion, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    stacked: np.ndarray = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    return stacked


def tilt(
    quaternion: Float[np.ndarray, "B 4"], acceleration: Float[np.ndarray, "B 3"]
) -> Float[np.ndarray, " B"]:
    """Angle [rad] between the spoon's own up and what its food feels as up.

    Args:
        quaternion: Of the spoon, w, x, y, z.
        acceleration: Of the spoon over the control step [m/s²], world frame.
    """
    felt = acceleration + np.array([0.0, 0.0, GRAVITY])
    up = matrices(quaternion)[..., 1]
    cosine = np.einsum("bi,bi->b", up, felt) / np.maximum(np.linalg.norm(felt, axis=1), 1e-9)
    angle: np.ndarray = np.arccos(np.clip(cosine, -1, 1))
    return angle


def eaten_now(
    food: Int[np.ndarray, "B 8"],
    where: Float[np.ndarray, "B S 8 3"],
    mouth: Float[np.ndarray, "B S 3"],
) -> Bool[np.ndarray, "B 8"]:
    """Pieces on the spoon that are near the mouth at any of S physics steps."""
    gap = np.linalg.norm(where - mouth[:, :, None], axis=-1)
    near: np.ndarray = (gap < EATEN_WITHIN).any(axis=1) & (food == Piece.HELD)
    return near


def spilled_now(
    food: Int[np.ndarray, "B 8"], angle: Float[np.ndarray, " B"]
) -> Bool[np.ndarray, "B 8"]:
    """Pieces on the spoon that fall at its tilt [rad]."""
    falling: np.ndarray = (angle[:, None] > SPILL_TILT) & (food == Piece.HELD)
    return falling

"""Poses of an episode as text: int16 in base64, a quarter of what float64 would take.

The resolution is 0.1 mm and 2e-5 in a quaternion's components: finer than the eye sees in a
replay, and than the physics step resolves. Not for measurement.
"""

from __future__ import annotations

import base64
import binascii
from typing import Final

import numpy as np
from jaxtyping import Float, Int16

POSITION_UNIT: Final = 1e-4  # [m]
QUATERNION_UNIT: Final = 1 / 32767
REACH: Final = 32767 * POSITION_UNIT  # [m], the farthest coordinate that fits.

_UNITS = np.array([POSITION_UNIT] * 3 + [QUATERNION_UNIT] * 4)


def quantize_poses(
    poses: Float[np.ndarray, "frames bodies 7"],
) -> Int16[np.ndarray, "frames bodies 7"]:
    """Returns poses in units of 1e-4 m (position) and 1/32767 (unit quaternion w, x, y, z).

    Raises:
        ValueError: A pose is not finite, lies outside ±3.2767 m or has a zero quaternion.
    """
    if not np.isfinite(poses).all():
        frame, body, _ = np.argwhere(~np.isfinite(poses))[0]
        raise ValueError(f"poses[{frame}, {body}] is not finite: {poses[frame, body]}")
    farthest = np.abs(poses[..., :3]).max(initial=0.0)
    if farthest > REACH:
        raise ValueError(f"poses reach {farthest:.2f} m, but only ±{REACH} m can be stored")
    length = np.linalg.norm(poses[..., 3:], axis=-1, keepdims=True)
    if (length == 0).any():
        raise ValueError("poses hold a quaternion of length 0")
    unit = np.concatenate([poses[..., :3], poses[..., 3:] / length], axis=-1)
    quantized: Int16[np.ndarray, "frames bodies 7"] = np.rint(unit / _UNITS).astype(np.int16)
    return quantized


def encode_poses(poses: Float[np.ndarray, "frames bodies 7"]) -> str:
    """Returns poses as base64 of little-endian int16, ready for the report's payload.

    Args:
        poses: Position x, y, z [m] in the world and quaternion w, x, y, z, per frame and body.

    Raises:
        ValueError: As `quantize_poses`.

    Example:
        >>> encode_poses(np.array([[[0.0001, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]]))
        'AQAAAAAA/38AAAAAAAA='
    """
    return base64.b64encode(quantize_poses(poses).astype("<i2").tobytes()).decode("ascii")


def decode_poses(text: str, *, frames: int, bodies: int) -> Float[np.ndarray, "frames bodies 7"]:
    """Returns what `encode_poses` stored, in metres and near-unit quaternions.

    Raises:
        ValueError: `text` is not base64, or does not hold frames × bodies poses.
    """
    try:
        raw = base64.b64decode(text, validate=True)
    except binascii.Error as error:
        raise ValueError(f"poses are not base64: {error}") from error
    if len(raw) != 2 * frames * bodies * 7:
        raise ValueError(f"poses hold {len(raw)} bytes, not {frames} frames × {bodies} bodies × 14")
    return restore_poses(np.frombuffer(raw, dtype="<i2").reshape(frames, bodies, 7))


def restore_poses(
    quantized: Int16[np.ndarray, "frames bodies 7"],
) -> Float[np.ndarray, "frames bodies 7"]:
    """Returns what `quantize_poses` rounded, in metres and near-unit quaternions."""
    poses: Float[np.ndarray, "frames bodies 7"] = quantized * _UNITS
    return poses

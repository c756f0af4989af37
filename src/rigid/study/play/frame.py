"""A moment of a live episode as bytes, as the page reads them.

Little endian: step (u32), flags (u8: 1 unwanted contact, 2 done), physics steps S (u8), bodies B
(u16), counted (u16), nothing (u16), the hand x, y, z [m] (3 f32), then S times B poses of 7 int16
as `rigid.report.poses.quantize_poses` makes them.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from rigid.report.poses import quantize_poses, restore_poses

_HEAD = struct.Struct("<IBBHHH3f")
_UNWANTED, _DONE = 1, 2


class Frame(NamedTuple):
    """The scene after a control step, and how it came there."""

    step: int
    """0 before the first one."""
    poses: Float[np.ndarray, "S bodies 7"]
    """Of `PlayedEpisode.bodies` after each physics step of the control step; S is 1 at step 0."""
    hand: Float[np.ndarray, "3"]
    """Of the human, or whatever point the player moves; world frame [m]."""
    unwanted: bool
    """Whether the robot touched the person where it should not, in this control step."""
    counted: int
    """How much of the aim is reached so far: counted contacts, pieces eaten."""
    done: bool


def frame_bytes(frame: Frame) -> bytes:
    """A frame as it is sent.

    Raises:
        ValueError: As `quantize_poses`.
    """
    substeps, bodies, _ = frame.poses.shape
    flags = _UNWANTED * frame.unwanted | _DONE * frame.done
    head = _HEAD.pack(frame.step, flags, substeps, bodies, frame.counted, 0, *frame.hand)
    return head + quantize_poses(frame.poses).astype("<i2").tobytes()


def read_frame(data: bytes) -> Frame:
    """What `frame_bytes` wrote, to the resolution of stored poses.

    Raises:
        ValueError: The bytes are too few or too many.
    """
    if len(data) < _HEAD.size:
        raise ValueError(f"a frame of {len(data)} bytes is shorter than its head of {_HEAD.size}")
    step, flags, substeps, bodies, counted, _, *hand = _HEAD.unpack_from(data)
    wanted = _HEAD.size + 14 * substeps * bodies
    if len(data) != wanted:
        raise ValueError(f"{substeps} × {bodies} poses make {wanted} bytes, not {len(data)}")
    stored = np.frombuffer(data, dtype="<i2", offset=_HEAD.size).reshape(substeps, bodies, 7)
    return Frame(
        step, restore_poses(stored), np.array(hand), bool(flags & _UNWANTED), counted,
        bool(flags & _DONE),
    )  # fmt: skip

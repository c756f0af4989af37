"""An episode as it is drawn: where every body and shape is at any time, and what was touched.

Everything comes from the report's payload (`rigid.report.payload`), so that any task which fills it
can be drawn.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.errors import UserError
from rigid.report.poses import decode_poses

_ORIGIN = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
_UNWANTED = 2
"""Kind of a contact that should not be (`rigid.report.payload.Replay`)."""
_NEEDED = ("bodies", "frames", "poses")


class Touch(NamedTuple):
    """An unwanted contact."""

    frame: int
    at: Float[np.ndarray, "3"]
    """In the world [m]."""
    geom: int
    """The human geom that is nearest, as an index into the scene's; -1 where there is none."""


class Anchor(NamedTuple):
    """A point that rides on a body."""

    body: int
    pos: Float[np.ndarray, "3"]
    """In the body's frame [m]."""


class Placed(NamedTuple):
    """Where the scene's geoms are in the world."""

    positions: Float[np.ndarray, "geoms 3"]
    turns: Float[np.ndarray, "geoms 3 3"]
    """Columns are the geom's axes."""


@dataclass(frozen=True)
class Motion:
    """One episode: poses of every body of the scene, the itch, and unwanted contacts."""

    poses: Float[np.ndarray, "frames bodies 7"]
    """x, y, z [m] and quaternion w, x, y, z."""
    dt: float
    """Between frames [s]."""
    itch: Anchor | None
    touches: tuple[Touch, ...]
    force_unwanted: Float[np.ndarray, " frames"]
    """Largest force where nothing should touch, in the step that ends at each frame [N]."""

    @property
    def last(self) -> int:
        """The last frame."""
        return len(self.poses) - 1

    def at(self, time: float) -> Float[np.ndarray, "bodies 7"]:
        """Every body's pose at `time` [frames].

        Positions are linear between frames; quaternions are too, on the shorter way and normalised:
        frames are so close that the eye does not tell it from a turn of constant speed.
        """
        time = min(max(time, 0.0), float(self.last))
        first = min(int(time), max(self.last - 1, 0))
        before, after = self.poses[first], self.poses[min(first + 1, self.last)]
        along = np.sum(before[:, 3:] * after[:, 3:], axis=1, keepdims=True)
        shorter = np.concatenate([after[:, :3], np.where(along < 0, -1, 1) * after[:, 3:]], axis=1)
        mixed = before + (time - first) * (shorter - before)
        length = np.linalg.norm(mixed[:, 3:], axis=1, keepdims=True)
        return np.concatenate([mixed[:, :3], mixed[:, 3:] / length], axis=1)

    def path(self, anchor: Anchor) -> Float[np.ndarray, "frames 3"]:
        """Where a point of a body was in the world at every frame [m]."""
        return carry(self.poses[:, anchor.body], anchor.pos)


class Shown(NamedTuple):
    """An episode to be looked at."""

    title: str
    """A line or two."""
    motion: Motion
    canonical: Motion | None
    """The synthetic human's, from the same start."""


def read_motion(scene: Mapping[str, Any], replay: Mapping[str, Any]) -> Motion:
    """The motion of a replay, whose poses are an array as `Task.replay` gives or text as stored.

    Args:
        scene: `rigid.report.payload.Scene`.
        replay: `rigid.report.payload.Replay`.

    Raises:
        UserError: The replay holds no poses.
        ValueError: The poses do not fit the scene.
    """
    lacking = [name for name in _NEEDED if name not in replay]
    if lacking:
        raise UserError(
            f"this task's episodes cannot be drawn: its replay has no {lacking[0]}, only "
            f"{', '.join(sorted(replay)) or 'nothing'}"
        )
    moving, frames = list(replay["bodies"]), int(replay["frames"])
    given = replay["poses"]
    if isinstance(given, str):
        given = decode_poses(given, frames=frames, bodies=len(moving))
    poses = np.tile(_rest(scene), (frames, 1, 1))
    poses[:, moving] = given
    itch = replay.get("itch")
    marks = [mark for mark in replay.get("contacts", ()) if mark[5] == _UNWANTED]
    return Motion(
        poses=poses,
        dt=float(replay.get("dt", 0.1)),  # As the page has it.
        itch=None if itch is None else Anchor(int(itch["body"]), np.array(itch["pos"], float)),
        touches=tuple(_touch(scene, poses, mark) for mark in marks),
        force_unwanted=np.array(replay.get("force_unwanted", np.zeros(frames)), float),
    )


def _rest(scene: Mapping[str, Any]) -> Float[np.ndarray, "bodies 7"]:
    rest = scene.get("rest")
    if rest is None:
        return np.tile(_ORIGIN, (len(scene["bodies"]), 1))
    return np.array(rest, float)


def carry(
    pose: Float[np.ndarray, "*n 7"], point: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "*n 3"]:
    """A point of a body's frame in the world [m], at one or more of the body's poses."""
    turned = Rotation.from_quat(pose[..., 3:], scalar_first=True).apply(point)
    return np.asarray(pose[..., :3] + turned)


def placed(scene: Mapping[str, Any], poses: Float[np.ndarray, "bodies 7"]) -> Placed:
    """Every geom of a scene that has some, with its bodies at `poses`."""
    geoms = scene["geoms"]
    carrier = poses[[geom["body"] for geom in geoms]]
    turn = Rotation.from_quat(carrier[:, 3:], scalar_first=True)
    own = Rotation.from_quat([geom["quat"] for geom in geoms], scalar_first=True)
    positions = carrier[:, :3] + turn.apply([geom["pos"] for geom in geoms])
    return Placed(positions, (turn * own).as_matrix())


def tip_of(scene: Mapping[str, Any]) -> Anchor | None:
    """The tool's tip: the body "tool_tip", else the geom "tip" or "…_tip"."""
    if "tool_tip" in scene["bodies"]:
        return Anchor(list(scene["bodies"]).index("tool_tip"), np.zeros(3))
    for geom in scene["geoms"]:
        if geom["name"] == "tip" or geom["name"].endswith("_tip"):
            return Anchor(int(geom["body"]), np.array(geom["pos"], float))
    return None


def _touch(scene: Mapping[str, Any], poses: np.ndarray, mark: Sequence[float]) -> Touch:
    """The unwanted contact of a mark, with the part of the person that it is on."""
    frame, at = int(mark[0]), np.array(mark[1:4], float)
    where, gaps = placed(scene, poses[frame]), {}
    for index, geom in enumerate(scene["geoms"]):
        if geom["role"] == "human" and geom["body"] == (mark[7] if len(mark) > 7 else geom["body"]):
            in_geom = (at - where.positions[index]) @ where.turns[index]
            gaps[index] = gap(geom, in_geom)
    return Touch(frame, at, min(gaps, key=gaps.__getitem__, default=-1))


def gap(geom: Mapping[str, Any], point: Float[np.ndarray, "3"]) -> float:
    """Distance [m] from a point in a geom's frame to its surface, negative inside.

    An ellipsoid counts as the sphere of its mean radius: good enough to tell limbs apart.

    Example:
        >>> gap({"type": "capsule", "size": [0.25, 0.5, 0]}, np.array([0.75, 0.0, 0.2]))
        0.5
    """
    size = [float(length) for length in geom["size"]]
    across = float(np.hypot(point[0], point[1]))
    if geom["type"] == "capsule":
        beyond = max(abs(point[2]) - size[1], 0.0)
        return float(np.hypot(across, beyond)) - size[0]
    if geom["type"] == "cylinder":
        return max(across - size[0], float(abs(point[2])) - size[1])
    if geom["type"] == "box":
        return float(np.max(np.abs(point) - np.array(size)))
    radius = float(np.mean(size)) if geom["type"] == "ellipsoid" else size[0]
    return float(np.linalg.norm(point)) - radius


def half_lengths(geom: Mapping[str, Any]) -> Float[np.ndarray, "3"]:
    """Half-lengths of the box around a geom, in its own frame [m]."""
    size = [*geom["size"], 0.0, 0.0]
    if geom["type"] == "sphere":
        return np.full(3, size[0])
    if geom["type"] == "capsule":
        return np.array([size[0], size[0], size[1] + size[0]])
    if geom["type"] == "cylinder":
        return np.array([size[0], size[0], size[1]])
    return np.array(size[:3], float)

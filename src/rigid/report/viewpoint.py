"""Where to look from, so that robot, person and the place of contact are all seen.

The rule is that of the report's 3D view (`web/src/replay/viewpoint.ts`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Float

from rigid.report.motion import Motion, placed, tip_of

FIELD_OF_VIEW: Final = 32.0
"""Vertical [deg]."""
_ELEVATION, _TURN = np.deg2rad(24.0), np.deg2rad(24.0)
"""From above, and turned from square-on, so that depth is read."""
_FILLED = 0.78
"""How much of the box around all that matters has to fit, by radius; its corners are empty."""
_UPPER_BODY = 0.15
"""So far below the action the person still matters [m]; legs do not."""
_HEAD = 0.16
"""From the middle of a head to above its top [m]; people look for faces first."""


@dataclass(frozen=True)
class Viewpoint:
    """A camera that stands at `position` and looks at `target`, both in the world [m]."""

    position: Float[np.ndarray, "3"]
    target: Float[np.ndarray, "3"]

    @property
    def axes(self) -> Float[np.ndarray, "3 3"]:
        """Rows: to the right of the picture, up in it, and forward into it."""
        forward = _unit(self.target - self.position)
        right = _unit(np.cross(forward, (0.0, 0.0, 1.0)))
        return np.array([right, np.cross(right, forward), forward])

    def project(
        self, points: Float[np.ndarray, "n 3"], width: int, height: int
    ) -> Float[np.ndarray, "n 2"]:
        """Where points are in a picture of that size: pixels from its left and from its top."""
        right, up, forward = ((points - self.position) @ self.axes.T).T
        focal = height / 2 / np.tan(np.deg2rad(FIELD_OF_VIEW / 2))
        return np.stack(
            [width / 2 + focal * right / forward, height / 2 - focal * up / forward], axis=1
        )


def viewpoint_for(
    scene: Mapping[str, Any], motion: Motion, *, aspect: float = 4 / 3, free: float = 0.0
) -> Viewpoint:
    """Beside the line from person to robot, on the side that the person faces, a little above.

    Args:
        scene: `rigid.report.payload.Scene`.
        motion: An episode in it, all of which is to be seen.
        aspect: Width of the picture over its height.
        free: Share of the picture's height that the person leaves free at its top.
    """
    human, start = centres(scene, motion, "human"), centres(scene, motion, "robot")
    robot = centres(scene, motion, "robot", [0.0, 1 / 3, 2 / 3, 1.0])
    action = _action(scene, motion)
    everything = np.concatenate([human, robot, action])
    if not len(everything):
        everything = centres(scene, motion, None)
    focus = (action if len(action) else everything).mean(axis=0)

    side = _side(human, start)
    upper = human[human[:, 2] > focus[2] - _UPPER_BODY]
    near = np.concatenate([robot, upper, action])
    box = near if len(near) else everything
    low, high = box.min(axis=0), box.max(axis=0)
    target = 0.55 * (low + high) / 2 + 0.45 * focus
    radius = _FILLED * max(float(np.linalg.norm(high - low)) / 2, 0.1)
    direction = np.append(np.cos(_ELEVATION) * side, np.sin(_ELEVATION))
    distance = radius / np.sin(np.deg2rad(FIELD_OF_VIEW / 2)) / min(aspect, 1.0)
    target = target + _raised(upper + (0.0, 0.0, _HEAD) - target, direction, distance, free)
    return Viewpoint(target + distance * direction, target)


def _raised(
    points: Float[np.ndarray, "n 3"],
    direction: Float[np.ndarray, "3"],
    distance: float,
    free: float,
) -> Float[np.ndarray, "3"]:
    """By how much target and camera rise, so that points lie below what is free at the top.

    Moving away instead would make everything smaller.
    """
    up = _unit(np.array([0.0, 0.0, 1.0]) - direction[2] * direction)
    slope = (1 - 2 * free) * np.tan(np.deg2rad(FIELD_OF_VIEW / 2))
    beyond = points @ up - slope * (distance - points @ direction)
    return np.asarray(max(beyond.max(initial=0.0), 0.0) * up)


def centres(
    scene: Mapping[str, Any], motion: Motion, role: str | None, shares: Sequence[float] = (0.0,)
) -> Float[np.ndarray, "n 3"]:
    """Centres of the geoms of a role (None: all) at some moments, as shares of the episode."""
    which = [
        index for index, geom in enumerate(scene["geoms"]) if role is None or geom["role"] == role
    ]
    moments = [placed(scene, motion.at(share * motion.last)) for share in shares]
    return np.concatenate([moment.positions[which] for moment in moments])


def _action(scene: Mapping[str, Any], motion: Motion) -> Float[np.ndarray, "n 3"]:
    """Where the tool's tip and the itch are during the episode."""
    anchors = [anchor for anchor in (tip_of(scene), motion.itch) if anchor is not None]
    return np.concatenate([np.zeros((0, 3)), *(motion.path(anchor) for anchor in anchors)])


def _side(
    human: Float[np.ndarray, "n 3"], robot: Float[np.ndarray, "m 3"]
) -> Float[np.ndarray, "2"]:
    """Horizontal direction from the action to the camera."""
    across = np.array([1.0, 0.0])
    if len(human) and len(robot):
        between = (robot.mean(axis=0) - human.mean(axis=0))[:2]
        across = _unit(between) if np.linalg.norm(between) > 1e-3 else across
    side = np.array([-across[1], across[0]])
    if side @ facing(human) < 0:
        side = -side
    return _unit(side + np.tan(_TURN) * across)


def facing(human: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "2"]:
    """Where the person faces, horizontally: a seated person's legs are before the trunk.

    Args:
        human: Centres of the person's geoms [m]; of fewer than two nothing is known: 0, 0.
    """
    if len(human) < 2:
        return np.zeros(2)
    by_height = human[np.argsort(human[:, 2], kind="stable")]
    half = len(human) // 2
    return np.asarray(by_height[:half].mean(axis=0) - by_height[half:].mean(axis=0))[:2]


def _unit(vector: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    return np.asarray(vector / np.linalg.norm(vector))

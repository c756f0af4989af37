"""Which body may touch which: one bit for each role, one affinity mask for each role.

MuJoCo lets two geoms collide when `contype` of one meets `conaffinity` of the other, so every
unordered pair of roles is listed once. Naming the pairs keeps the contact count low (about three
active contacts a step) and makes the omissions visible. Links of the robot that are not neighbours
stay 5 cm apart, and the tool 15 cm from forearm and wrist, in every pose within the joint limits.
"""

from __future__ import annotations

from enum import IntFlag

import mujoco


class Role(IntFlag):
    """What a collision geom belongs to."""

    NONE = 0
    ARM = 1  # The human's moving right arm: upper arm, forearm, hand.
    SHOULDER = 2  # The moving right shoulder girdle; never meets its own arm or trunk.
    TRUNK = 4  # Everything of the human that does not move.
    CHAIR = 8
    ROBOT = 16  # Links near the robot's base.
    WRIST = 32  # Forearm, wrist and hand of the robot.
    TOOL = 64
    HEAD = 128  # A head that moves; never meets its own trunk.


_PERSON = Role.ARM | Role.SHOULDER | Role.TRUNK | Role.HEAD
_AFFINITY = {
    Role.ARM: Role.TRUNK | Role.CHAIR,
    Role.SHOULDER: Role.NONE,
    Role.TRUNK: Role.NONE,
    Role.CHAIR: Role.NONE,
    Role.ROBOT: _PERSON | Role.CHAIR,
    Role.WRIST: _PERSON | Role.CHAIR | Role.ROBOT,
    Role.TOOL: _PERSON | Role.CHAIR | Role.ROBOT,
    Role.HEAD: Role.CHAIR,
    Role.NONE: Role.NONE,
}


def assign(geom: mujoco.MjsGeom, role: Role) -> None:
    """Gives `geom` the collision bits of `role`; `Role.NONE` makes it visual only."""
    geom.contype = int(role)
    geom.conaffinity = int(_AFFINITY[role])

"""A head that moves: neck, skull and a mouth held open, with 4 joints.

Joints, limits, shares of mass and the mouth's place are those of Assistive Gym's capsule human.
Its head is a closed mesh, whose lips a spoon cannot pass; ours has an opening, since food enters
there. Axes: positive `neck` and `head_x` nod, the face looks along -y.
"""

from __future__ import annotations

import mujoco
import numpy as np

from rigid.tasks.bodies.collision import Role, assign
from rigid.tasks.bodies.human import SKIN, add_neck, chest_origin
from rigid.tasks.bodies.jaco import Servo, add_servo
from rigid.tasks.bodies.sizes import BodySize

HEAD_JOINTS = ("neck", "head_x", "head_y", "head_z")
"""The controllable joints, in the order of the human's action."""
HEAD_PARTS = ("neck", "head")
HEAD_BODY = "head"
MOUTH_SITE = "mouth"

_AXES = ((1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_LIMITS_DEG = ((-10.0, 20.0), (-50.0, 50.0), (-34.0, 34.0), (-70.0, 70.0))
_NECK_SHARE, _HEAD_SHARE = 0.01, 0.07  # Of the body's mass.
_LIP, _OPEN = 0.010, 0.0185
"""Radius of the lips and half the height of the opening between them [m]. Ours: 3.7 cm, enough
for a spoon with food (2 cm)."""
_HALF_WIDTH = 0.028
"""Of the opening [m]. Ours: half a centimetre to either side of the spoon's bowl with the lips."""
_LIPS = (0.72, 0.38, 0.36, 1.0)
_MOUTH = (0.35, 0.10, 0.12, 1.0)


def head_limits(scale: float) -> np.ndarray:
    """Joint limits [rad] of neck and head, shape (4, 2), times `scale` in (0, 1]."""
    limits: np.ndarray = np.deg2rad(_LIMITS_DEG) * scale
    return limits


def add_moving_head(
    spec: mujoco.MjSpec, size: BodySize, *, servo: Servo, limit_scale: float = 1.0
) -> None:
    """Adds neck and head on a body that has none, with 4 servos and the site `mouth`.

    Args:
        spec: The scene under construction.
        size: Lengths and mass of the body.
        servo: Drive of the head; its torque caps are in the order of `HEAD_JOINTS`.
        limit_scale: Impairment `limits`: factor on the joint ranges, in (0, 1].
    """
    limits = head_limits(limit_scale)
    neck = spec.worldbody.add_body(name="neck", pos=chest_origin(size) + (0, 0, size.neck[3]))
    _add_joints(spec, neck, slice(0, 1), limits, servo)
    add_neck(neck, size, np.zeros(3), Role.HEAD, _NECK_SHARE)
    head = neck.add_body(name=HEAD_BODY, pos=(0, 0, size.head[3]))
    _add_joints(spec, head, slice(1, 4), limits, servo)
    _add_skull(head, size)
    _add_lips(head, size)
    y, z = size.mouth
    head.add_site(name=MOUTH_SITE, pos=(0, y, z), size=(0.01, 0, 0))


def _add_joints(
    spec: mujoco.MjSpec, body: mujoco.MjsBody, which: slice, limits: np.ndarray, servo: Servo
) -> None:
    for index in range(*which.indices(len(HEAD_JOINTS))):
        joint = body.add_joint(
            name=HEAD_JOINTS[index], axis=_AXES[index], range=limits[index], limited=True
        )
        add_servo(spec, joint, servo, servo.torque_caps[index])


def _add_skull(head: mujoco.MjsBody, size: BodySize) -> None:
    """Two ellipsoids that leave the mouth open, with cheeks and throat behind it.

    Together they come near the ellipsoid of the head that does not move.
    """
    (half_x, half_y, half_z, _), (y, z), (mouth_y, mouth_z) = (
        size.head,
        size.head_center,
        size.mouth,
    )
    top, bottom = z + half_z, z - half_z
    upper, lower = mouth_z + 0.4 * _OPEN, mouth_z - _OPEN
    deep = mouth_y + 0.045  # Where the throat begins.
    shapes = (
        ("skull", (0, y, (top + upper) / 2), (half_x, half_y, (top - upper) / 2)),
        ("chin", (0, y + 0.01, (lower + bottom) / 2), (0.85 * half_x, 0.8 * half_y,
                                                      (lower - bottom) / 2)),
        ("right_cheek", (-_HALF_WIDTH - 0.022, mouth_y + 0.064, mouth_z), (0.026, 0.06, 0.05)),
        ("left_cheek", (_HALF_WIDTH + 0.022, mouth_y + 0.064, mouth_z), (0.026, 0.06, 0.05)),
        ("throat", (0, deep + 0.05, mouth_z), (0.9 * half_x, 0.05, 0.05)),
    )  # fmt: skip
    for name, position, half in shapes:
        geom = head.add_geom(
            name=name, type=mujoco.mjtGeom.mjGEOM_ELLIPSOID, size=half, pos=position, rgba=SKIN,
            mass=_HEAD_SHARE * size.mass if name == "skull" else 0.0,
        )  # fmt: skip
        assign(geom, Role.HEAD)
    inside = head.add_geom(
        name="mouth", type=mujoco.mjtGeom.mjGEOM_ELLIPSOID, size=(_HALF_WIDTH, 0.012, _OPEN),
        pos=(0, deep, mouth_z), rgba=_MOUTH, mass=0.0,
    )  # fmt: skip
    assign(inside, Role.NONE)


def _add_lips(head: mujoco.MjsBody, size: BodySize) -> None:
    y, z = size.mouth
    for name, sign in (("upper_lip", 1), ("lower_lip", -1)):
        height = z + sign * (_OPEN + _LIP)
        geom = head.add_geom(
            name=name, type=mujoco.mjtGeom.mjGEOM_CAPSULE, size=(_LIP, 0, 0),
            fromto=(-_HALF_WIDTH, y + _LIP, height, _HALF_WIDTH, y + _LIP, height), rgba=_LIPS,
            mass=0.0,
        )  # fmt: skip
        assign(geom, Role.HEAD)

"""The spoon held by the robot, lying across the palm (sizes of Assistive Gym's mesh).

Frame of the spoon: its origin is the bottom of the bowl, z points along the handle, y out of the
bowl. The bowl is a solid ellipsoid as high as the mesh's rim: food lies on it by rule, not by
contact (`rigid.tasks.feeding.food`).
"""

from __future__ import annotations

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies.collision import Role, assign

SPOON_BODY = "spoon"
SPOON_SITE = "spoon"
BOWL_GEOM = "spoon_bowl"
TIP = (0.0, 0.009, -0.0275)
"""Foremost point of the bowl [m], in the spoon's frame."""

_PLACE = np.array([0.1, -0.0225, 0.03])
"""Of the spoon in the end effector's frame [m] (Assistive Gym, Jaco)."""
_TURN = Rotation.from_euler("xyz", (-0.1, -np.pi / 2, 0.0))
"""Of the spoon in the end effector's frame (Assistive Gym, Jaco)."""
_HAND_TO_EFFECTOR = Rotation.from_quat((0, 1, 0, 0), scalar_first=True)
_REACH = np.array([0.0, 0.0, -0.16])  # [m], the end effector in the hand's frame.
_MASS = 1.0
"""[kg], at the bowl (Assistive Gym)."""
RGBA = (0.75, 0.77, 0.80, 1.0)


def add_spoon(hand: mujoco.MjsBody) -> mujoco.MjsBody:
    """Welds the spoon into the hand of a Jaco; returns its body.

    The original's fixed constraint (500 N) is a rigid weld here. The arm's fingers end short of
    the handle: they hold it by a grip (ours).
    """
    spoon = hand.add_body(
        name=SPOON_BODY,
        pos=_REACH + _HAND_TO_EFFECTOR.apply(_PLACE),
        quat=(_HAND_TO_EFFECTOR * _TURN).as_quat(scalar_first=True),
    )
    bowl = spoon.add_geom(
        name=BOWL_GEOM, type=mujoco.mjtGeom.mjGEOM_ELLIPSOID, size=(0.0179, 0.0065, 0.0245),
        pos=(0, 0.0073, -0.005), mass=_MASS, rgba=RGBA,
    )  # fmt: skip
    assign(bowl, Role.TOOL)
    palm = _TURN.inv().apply(-_PLACE)
    for name, ends, radius in (
        ("spoon_neck", ((0, 0.012, 0.018), (0, 0.0165, 0.036)), 0.003),
        ("spoon_handle", ((0, 0.0165, 0.036), (0, 0.0045, 0.135)), 0.004),
        ("spoon_grip", (tuple(palm), (0, 0.009, 0.1)), 0.011),
    ):
        geom = spoon.add_geom(
            name=name, type=mujoco.mjtGeom.mjGEOM_CAPSULE, size=(radius, 0, 0),
            fromto=np.concatenate(ends), mass=0.0, rgba=RGBA,
        )  # fmt: skip
        assign(geom, Role.TOOL)
    spoon.add_site(name=SPOON_SITE, pos=(0, 0, 0))
    return spoon

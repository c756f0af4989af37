"""The wiper held by the robot: a handle and a flat pad under it (Assistive Gym's sizes).

Frame of the wiper: x points out of the palm, along the pad, and z away from the pad's underside.
"""

from __future__ import annotations

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies.collision import Role, assign

WIPER_BODY, PAD_BODY = "wiper", "wiper_pad"
PAD_GEOM, HANDLE_GEOM = "wiper_pad", "wiper_handle"
PAD_SITE = "wiper_pad"
"""Middle of the pad's lower half, which is what the original observes."""

PAD_HALF = (0.05, 0.025, 0.00575)
"""[m]: the original's pad of 10 x 5 x 1 cm, with the cloth that shows 1.5 mm below it."""
_PAD_AT, _SITE_AT = (0.0, 0.0, -0.03575), (0.0, 0.0, -0.039)
_HANDLE_HALF, _HANDLE_AT = (0.02, 0.02, 0.03), (0.0, 0.0, -0.01)
_PLACE = np.array([-0.01, 0.0, 0.03])
"""Of the wiper in the end effector's frame [m] (Assistive Gym, Jaco)."""
_TURN = Rotation.from_euler("xyz", (0.0, -np.pi / 2, 0.0))
"""Of the wiper in the end effector's frame (Assistive Gym, Jaco)."""
_HAND_TO_EFFECTOR = Rotation.from_quat((0, 1, 0, 0), scalar_first=True)
_REACH = np.array([0.0, 0.0, -0.16])  # [m], the end effector in the hand's frame.
_HANDLE_MASS, _PAD_MASS = 0.1, 0.2  # [kg]: the original's pad and cloth have 0.1 each.
_HANDLE_RGBA, _PAD_RGBA = (0.55, 0.60, 0.66, 1.0), (0.30, 0.62, 0.80, 1.0)


def add_wiper(hand: mujoco.MjsBody) -> None:
    """Welds the wiper into the hand of a Jaco, its pad a body of its own.

    The original's fixed constraint (500 N) is a rigid weld here.
    """
    wiper = hand.add_body(
        name=WIPER_BODY,
        pos=_REACH + _HAND_TO_EFFECTOR.apply(_PLACE),
        quat=(_HAND_TO_EFFECTOR * _TURN).as_quat(scalar_first=True),
    )
    # A body of its own: only what it touches may be wiped.
    pad = wiper.add_body(name=PAD_BODY)
    for body, name, half, place, mass, rgba in (
        (wiper, HANDLE_GEOM, _HANDLE_HALF, _HANDLE_AT, _HANDLE_MASS, _HANDLE_RGBA),
        (pad, PAD_GEOM, PAD_HALF, _PAD_AT, _PAD_MASS, _PAD_RGBA),
    ):
        geom = body.add_geom(
            name=name, type=mujoco.mjtGeom.mjGEOM_BOX, size=half, pos=place, mass=mass, rgba=rgba
        )
        assign(geom, Role.TOOL)
    pad.add_site(name=PAD_SITE, pos=_SITE_AT)

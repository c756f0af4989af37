"""The itch scratcher held by the robot: handle, rod and a rounded tip (Assistive Gym's sizes)."""

from __future__ import annotations

import mujoco
import numpy as np

from rigid.tasks.bodies.collision import Role, assign

TIP_GEOM, ROD_GEOM, HANDLE_GEOM = "scratcher_tip", "scratcher_rod", "scratcher_handle"
TIP_SITE = "scratcher_tip"

_TIP_REACH = 0.095  # [m] from the end effector to the tip along the palm's axis.
_RGBA = (0.93, 0.60, 0.20, 1.0)


def add_scratcher(hand: mujoco.MjsBody) -> None:
    """Welds the scratcher into the hand of a Jaco, pointing out of the palm.

    The palm's axis is -z of the last link; the end effector lies 0.16 m out. The original's fixed
    constraint (500 N) is a rigid weld here.
    """
    tool = hand.add_body(name="scratcher", pos=(0, 0, -0.16), quat=(0, 1, 0, 0))
    handle_middle = 0.02  # [m], offset of the handle from the end effector.
    shapes = (
        (HANDLE_GEOM, mujoco.mjtGeom.mjGEOM_BOX, (0.025, 0.025, 0.025), handle_middle, 0.1),
        # A capsule inside the original's cylinder; it ends behind the tip, so that a touch of the
        # tip is one contact.
        (ROD_GEOM, mujoco.mjtGeom.mjGEOM_CAPSULE, (0.01, 0.015, 0), handle_middle + 0.05, 0.1),
        (TIP_GEOM, mujoco.mjtGeom.mjGEOM_SPHERE, (0.01, 0, 0), _TIP_REACH, 0.1),
    )
    for name, kind, size, along, mass in shapes:
        geom = tool.add_geom(
            name=name, type=kind, size=size, pos=(0, 0, along), mass=mass, rgba=_RGBA
        )
        assign(geom, Role.TOOL)
    # Tool frame of the original: x out of the palm.
    tool.add_site(name=TIP_SITE, pos=(0, 0, _TIP_REACH), quat=(np.sqrt(0.5), 0, -np.sqrt(0.5), 0))

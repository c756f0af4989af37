"""Wheelchair of boxes and cylinders: what the arm can rest on and the robot can run into.

Extents are the bounding boxes of Assistive Gym's wheelchair parts, root at (0, 0, 0.06) [m].
"""

from __future__ import annotations

import mujoco
import numpy as np

from rigid.tasks.bodies.collision import Role, assign

JACO_MOUNT = (-0.35, -0.30, 0.36)
"""Where the Jaco's base stands in the world frame [m]; yaw -90°."""
JACO_YAW = -np.pi / 2

_FRAME = (0.20, 0.21, 0.23, 1.0)
_PAD = (0.12, 0.13, 0.15, 1.0)

# Name, lower corner, upper corner [m], colour.
_BOXES = (
    ("right_arm_rest", (-0.332, -0.205, 0.651), (-0.211, 0.059, 0.721), _PAD),
    ("left_arm_rest", (0.211, -0.205, 0.651), (0.332, 0.059, 0.721), _PAD),
    ("seat", (-0.269, -0.275, 0.43), (0.269, 0.05, 0.48), _PAD),
    ("head_rest", (-0.123, 0.225, 1.09), (0.123, 0.317, 1.236), _PAD),
    ("foot_plate", (-0.22, -0.546, 0.075), (0.273, -0.326, 0.093), _FRAME),
    ("chassis", (-0.20, -0.25, 0.15), (0.20, 0.30, 0.42), _FRAME),
)
_WHEEL_RADIUS = 0.115
_WHEELS_Y = (-0.30, 0.0, 0.29)


def add_wheelchair(spec: mujoco.MjSpec) -> None:
    """Adds the static wheelchair to the world body; there is no floor."""
    chair = spec.worldbody.add_body(name="wheelchair")
    for name, lower, upper, rgba in _BOXES:
        low, high = np.array(lower), np.array(upper)
        geom = chair.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=(low + high) / 2,
            size=(high - low) / 2,
            rgba=rgba,
        )
        assign(geom, Role.CHAIR)
    back = chair.add_geom(
        name="back_rest",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=(0, 0.26, 0.82),
        size=(0.26, 0.02, 0.25),
        quat=(np.cos(-0.34), np.sin(-0.34), 0, 0),  # Slopes back by 39° (.08 to .40 m over .40).
        rgba=_PAD,
    )
    assign(back, Role.CHAIR)
    for x in (-0.36, 0.36):
        for number, y in enumerate(_WHEELS_Y):
            side = "right" if x < 0 else "left"
            wheel = chair.add_geom(
                name=f"{side}_wheel_{number}",
                type=mujoco.mjtGeom.mjGEOM_CYLINDER,
                pos=(x, y, _WHEEL_RADIUS),
                size=(_WHEEL_RADIUS, 0.03, 0),
                quat=(np.sqrt(0.5), 0, np.sqrt(0.5), 0),
                rgba=_PAD,
            )
            assign(wheel, Role.NONE)

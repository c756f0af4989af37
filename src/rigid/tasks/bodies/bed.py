"""A bed with a pillow, and a bedside cabinet that carries the robot (Assistive Gym's extents).

The original's mattress is a wavy mesh between 0.68 and 0.77 m high; ours is flat.
"""

from __future__ import annotations

import mujoco
import numpy as np

from rigid.tasks.bodies.collision import Role, assign

BED_BODY, CABINET_BODY = "bed", "cabinet"
MATTRESS_TOP = 0.72
"""[m], the middle of the original's."""
JACO_STAND = (-1.05, 0.5, 0.6)
"""Where the Jaco's base stands [m]; the original draws it from (-1.4 … -0.9, 0.15 … 1.15, 0.6) and
turns it by up to 30° at every reset, wherever the arm reaches best. Ours is where, of 19 places, it
reaches the start and the whole arm best."""
JACO_YAW = 0.0
"""[rad]"""

_LINEN = (0.86, 0.89, 0.92, 1.0)
_PILLOW = (0.95, 0.95, 0.93, 1.0)
_WOOD = (0.60, 0.46, 0.34, 1.0)

# Name, lower corner, upper corner [m], colour.
_BED = (
    ("mattress", (-0.577, -1.14, 0.55), (0.376, 1.11, MATTRESS_TOP), _LINEN),
    ("bed_frame", (-0.60, -1.14, 0.30), (0.40, 1.11, 0.55), _WOOD),
    ("headboard", (-0.645, 1.11, 0.0), (0.418, 1.17, 1.16), _WOOD),
    ("footboard", (-0.645, -1.19, 0.0), (0.418, -1.14, 0.75), _WOOD),
)
_PILLOW_AT, _PILLOW_HALF = (-0.05, 0.62, MATTRESS_TOP + 0.005), (0.30, 0.20, 0.035)
_CABINET_HALF = 0.2


def add_bed(spec: mujoco.MjSpec) -> None:
    """Adds the bed, along y with its head at +y; the arm rests on it, the robot runs into it."""
    bed = spec.worldbody.add_body(name=BED_BODY)
    for name, lower, upper, rgba in _BED:
        _add_box(bed, name, np.array(lower), np.array(upper), rgba)
    pillow = bed.add_geom(
        name="pillow", type=mujoco.mjtGeom.mjGEOM_ELLIPSOID, pos=_PILLOW_AT, size=_PILLOW_HALF,
        rgba=_PILLOW,
    )  # fmt: skip
    assign(pillow, Role.CHAIR)


def add_cabinet(spec: mujoco.MjSpec) -> None:
    """Adds the bedside cabinet under `JACO_STAND`."""
    cabinet = spec.worldbody.add_body(name=CABINET_BODY)
    half, (x, y, top) = _CABINET_HALF, JACO_STAND
    low, high = np.array([x - half, y - half, 0.0]), np.array([x + half, y + half, top])
    _add_box(cabinet, "cabinet", low, high, _WOOD)


def _add_box(
    body: mujoco.MjsBody,
    name: str,
    low: np.ndarray,
    high: np.ndarray,
    rgba: tuple[float, float, float, float],
) -> None:
    geom = body.add_geom(
        name=name, type=mujoco.mjtGeom.mjGEOM_BOX, pos=(low + high) / 2, size=(high - low) / 2,
        rgba=rgba,
    )  # fmt: skip
    assign(geom, Role.CHAIR)

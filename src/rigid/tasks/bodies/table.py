"""The table in front of the wheelchair, with an empty bowl on it (Assistive Gym's extents)."""

from __future__ import annotations

import mujoco

from rigid.tasks.bodies.collision import Role, assign

_TOP = (0.25, -1.0, 0.70)
"""Middle of the table top [m]."""
_HALF = (0.75, 0.5, 0.025)
_BOWL = (-0.15, -0.65, 0.75)
"""Where the bowl stands [m]; the original moves it by up to 5 cm at every reset."""
_WOOD = (0.72, 0.60, 0.46, 1.0)
_CHINA = (0.93, 0.92, 0.89, 1.0)


def add_table(spec: mujoco.MjSpec) -> None:
    """Adds the table, which the robot can run into, and the bowl, which is only seen."""
    table = spec.worldbody.add_body(name="table")
    top = table.add_geom(
        name="table_top", type=mujoco.mjtGeom.mjGEOM_BOX, pos=_TOP, size=_HALF, rgba=_WOOD
    )
    assign(top, Role.CHAIR)
    bowl = table.add_geom(
        name="bowl", type=mujoco.mjtGeom.mjGEOM_ELLIPSOID, pos=_BOWL, size=(0.072, 0.072, 0.03),
        rgba=_CHINA,
    )  # fmt: skip
    assign(bowl, Role.NONE)

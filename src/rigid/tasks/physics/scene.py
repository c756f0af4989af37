"""How scenes are simulated, and the sensors that observe contacts and poses."""

from __future__ import annotations

from collections.abc import Iterable

import mujoco
import numpy as np

from rigid.tasks.bodies import jaco

CONTACTS_PER_PART = 6
"""Contacts kept for each body part; normal forces are summed, the strongest are kept."""
FRICTION = 0.25
"""Sliding friction of every contact: the original gives each link 0.5, and Bullet multiplies."""
CONTACT_TIME = 0.04
"""Time constant of contacts and limits [s]: MuJoCo's least at the original's physics step, stated
so that finer steps keep the same softness."""
PENETRATION = "penetration_"
"""How the names of sensors of overlaps begin."""
FOUND, FORCE, DIST, POS = (
    1 << int(f)
    for f in (
        mujoco.mjtConDataField.mjCONDATA_FOUND,
        mujoco.mjtConDataField.mjCONDATA_FORCE,
        mujoco.mjtConDataField.mjCONDATA_DIST,
        mujoco.mjtConDataField.mjCONDATA_POS,
    )
)
"""Fields of a contact sensor, which stand in this order."""
_MIN_DISTANCE, _MAX_FORCE = 1, 2  # MuJoCo's reductions; `netforce` would cancel opposed contacts.


def floating_spec(name: str, physics_step: float) -> mujoco.MjSpec:
    """An empty scene without gravity, as the original: every body floats once it is posed."""
    spec = mujoco.MjSpec()
    spec.modelname = name
    spec.compiler.degree = False
    spec.option.timestep = physics_step
    spec.option.gravity = (0, 0, 0)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # A runaway world must be seen, not silently put back to its defaults.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    spec.memory = 1 << 19
    return spec


def soften(spec: mujoco.MjSpec) -> None:
    """Gives contacts and limits of a finished scene their softness and friction."""
    for geom in spec.geoms:
        geom.solref[0] = CONTACT_TIME
        geom.friction[0] = FRICTION  # MuJoCo takes the larger of the two.
    for joint in spec.joints:
        joint.solref_limit[0] = CONTACT_TIME


def add_contact_sensor(
    spec: mujoco.MjSpec,
    name: str,
    one: tuple[mujoco.mjtObj, str],
    other: tuple[mujoco.mjtObj, str] | None,
    *,
    fields: int = FORCE,
    count: int = CONTACTS_PER_PART,
) -> None:
    """The strongest `count` contacts of `one` with `other` (None: with anything)."""
    sensor = _contact_sensor(spec, name, *one)
    if other is not None:
        sensor.reftype, sensor.refname = other
    sensor.intprm[:3] = (fields, _MAX_FORCE, count)


def add_person_sensors(spec: mujoco.MjSpec, parts: Iterable[str]) -> None:
    """Forces of robot and tool on each part of the person, named `contact_PART`."""
    for part in parts:
        robot = (mujoco.mjtObj.mjOBJ_XBODY, jaco.BASE_BODY)
        add_contact_sensor(spec, f"contact_{part}", robot, (mujoco.mjtObj.mjOBJ_BODY, part))


def add_penetration_sensors(spec: mujoco.MjSpec, roots: Iterable[str]) -> None:
    """The deepest overlap of each chain of bodies with anything."""
    for root in roots:
        sensor = _contact_sensor(spec, f"{PENETRATION}{root}", mujoco.mjtObj.mjOBJ_XBODY, root)
        sensor.intprm[:3] = (DIST, _MIN_DISTANCE, 1)


def _contact_sensor(
    spec: mujoco.MjSpec, name: str, kind: mujoco.mjtObj, of: str
) -> mujoco.MjsSensor:
    return spec.add_sensor(
        name=name, type=mujoco.mjtSensor.mjSENS_CONTACT, objtype=kind, objname=of
    )


def add_frame_sensors(spec: mujoco.MjSpec, sensors: Iterable[tuple[str, str, str]]) -> None:
    """Sensors of where things are, in this order.

    Args:
        spec: The scene.
        sensors: Of each its name, what it measures (`position`, `rotation`, `velocity`), and the
            site or else the body whose frame it measures.
    """
    kinds = {
        "position": mujoco.mjtSensor.mjSENS_FRAMEPOS,
        "rotation": mujoco.mjtSensor.mjSENS_FRAMEQUAT,
        "velocity": mujoco.mjtSensor.mjSENS_FRAMELINVEL,
    }
    sites = {site.name for site in spec.sites}
    for name, measured, of in sensors:
        frame = mujoco.mjtObj.mjOBJ_SITE if of in sites else mujoco.mjtObj.mjOBJ_XBODY
        spec.add_sensor(name=name, type=kinds[measured], objtype=frame, objname=of)


def driven_addresses(model: mujoco.MjModel, names: tuple[str, ...]) -> np.ndarray:
    """Positions in qpos, qvel and ctrl (equal here: every joint is a driven hinge)."""
    addresses = np.array([model.joint(name).qposadr[0] for name in names])
    driven = [model.actuator(f"{name}_servo").id for name in names]
    if not np.array_equal(addresses, driven):
        raise ValueError(f"joints {names} are not driven in order: {addresses} != {driven}")
    return addresses

"""The scene: who lies and stands where, and the sensors that observe contacts and poses."""

from __future__ import annotations

import mujoco

from rigid.tasks.bed_bathing.parameters import BedBathingParameters
from rigid.tasks.bed_bathing.points import LIMBS, arm_points
from rigid.tasks.bodies import bed, human, jaco, lying, wiper
from rigid.tasks.physics.scene import (
    FORCE,
    FOUND,
    POS,
    add_contact_sensor,
    add_frame_sensors,
    add_penetration_sensors,
    add_person_sensors,
    floating_spec,
    soften,
)

ARM = ("right_upper_arm", "right_forearm", "right_hand")
"""Bodies that the pad may touch."""
PAD_CONTACTS = 2
"""Contacts of the pad kept for each of them: MuJoCo finds no more of a box and a capsule."""
_FARTHEST = 3.0  # [m], ours: distances beyond it are not told apart.
_POINT = (0.10, 0.75, 0.85, 1.0)


def build_spec(parameters: BedBathingParameters) -> mujoco.MjSpec:
    """Assembles bed, person, arm and wiper, with their sensors."""
    spec = floating_spec("bed_bathing", parameters.physics_step)
    bed.add_bed(spec)
    bed.add_cabinet(spec)
    lying.add_lying_human(
        spec, parameters.body_size,
        servo=jaco.Servo(1.7, 0.03, (parameters.strength,) * len(human.ARM_JOINTS)),
        limit_scale=parameters.limit_scale,
    )  # fmt: skip
    hand = jaco.add_jaco(
        spec,
        position=bed.JACO_STAND,
        yaw=bed.JACO_YAW,
        servo=jaco.robot_servo(parameters.servo),
    )
    wiper.add_wiper(hand)
    soften(spec)
    _add_contact_sensors(spec)
    _add_pose_sensors(spec)
    return spec


def _add_contact_sensors(spec: mujoco.MjSpec) -> None:
    add_person_sensors(spec, lying.PARTS)
    for part in ARM:
        add_contact_sensor(
            spec,
            f"pad_{part}",
            (mujoco.mjtObj.mjOBJ_GEOM, wiper.PAD_GEOM),
            (mujoco.mjtObj.mjOBJ_GEOM, part),
            fields=FOUND | FORCE | POS,
            count=PAD_CONTACTS,
        )
    add_contact_sensor(spec, "contact_tool", (mujoco.mjtObj.mjOBJ_XBODY, wiper.WIPER_BODY), None)
    add_penetration_sensors(spec, (jaco.BASE_BODY, "right_shoulder"))


def _add_pose_sensors(spec: mujoco.MjSpec) -> None:
    sensors = (
        ("pad_position", "position", wiper.PAD_SITE),
        ("pad_rotation", "rotation", wiper.PAD_SITE),
        ("end_effector_velocity", "velocity", jaco.END_EFFECTOR_SITE),
        # A limb's body frame sits at the joint it hangs from.
        *((f"{part}_position", "position", part) for part in ARM),
        *((f"right_{limb}_rotation", "rotation", f"right_{limb}") for limb in LIMBS),
    )
    add_frame_sensors(spec, sensors)
    for limb in LIMBS:
        sensor = spec.add_sensor(
            name=f"pad_to_{limb}",
            type=mujoco.mjtSensor.mjSENS_GEOMDIST,
            objtype=mujoco.mjtObj.mjOBJ_GEOM,
            objname=wiper.PAD_GEOM,
            reftype=mujoco.mjtObj.mjOBJ_GEOM,
            refname=f"right_{limb}",
        )
        sensor.cutoff = _FARTHEST


def points_body(limb: human.Limb) -> str:
    """Name of the body of a limb's points, in the scene that is drawn."""
    return f"points_{limb}"


def add_points(spec: mujoco.MjSpec, parameters: BedBathingParameters) -> None:
    """Marks the points to wipe, to look at, and the middle of the pad.

    They have bodies of their own: a touched limb is shown red, and they are not to be taken for it.
    """
    points = arm_points(parameters.body_size)
    carriers = [spec.body(f"right_{limb}").add_body(name=points_body(limb)) for limb in LIMBS]
    for index, (place, limb) in enumerate(zip(points.places, points.limb, strict=True)):
        carriers[limb].add_geom(
            name=f"point_{index}", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=(0.004, 0, 0),
            pos=place, mass=0.0, rgba=_POINT, contype=0, conaffinity=0,
        )  # fmt: skip
    pad = spec.site(wiper.PAD_SITE)
    spec.body(wiper.PAD_BODY).add_geom(
        name="wiper_tip", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=(0.002, 0, 0), pos=pad.pos,
        mass=0.0, contype=0, conaffinity=0,
    )  # fmt: skip

"""The scene: who stands where, and the sensors that observe contacts and poses."""

from __future__ import annotations

import mujoco

from rigid.tasks.bodies import human, jaco, scratcher, wheelchair
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
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

_PARTS = human.ARM_PARTS + human.TRUNK_PARTS

LIMBS: tuple[human.Limb, ...] = ("forearm", "upper_arm")
"""Where it can itch; the human's one-hot itch feature has this order."""


def build_spec(parameters: ItchScratchingParameters) -> mujoco.MjSpec:
    """Assembles wheelchair, person, arm and scratcher, with their sensors."""
    spec = floating_spec("itch_scratching", parameters.physics_step)
    wheelchair.add_wheelchair(spec)
    size = parameters.body_size
    human.add_seated_human(
        spec, size, servo=_human_servo(parameters.strength), limit_scale=parameters.limit_scale
    )
    hand = jaco.add_jaco(
        spec,
        position=wheelchair.JACO_MOUNT,
        yaw=wheelchair.JACO_YAW,
        servo=jaco.robot_servo(parameters.servo),
    )
    scratcher.add_scratcher(hand)
    soften(spec)
    for limb in LIMBS:
        body, position, _ = human.itch_point(size, limb)
        spec.body(body).add_site(name=f"itch_{limb}", pos=position, size=(0.01, 0, 0))
    _add_contact_sensors(spec)
    _add_pose_sensors(spec)
    return spec


def _human_servo(strength: float) -> jaco.Servo:
    return jaco.Servo(1.7, 0.03, (strength,) * len(human.ARM_JOINTS))


def _add_contact_sensors(spec: mujoco.MjSpec) -> None:
    add_person_sensors(spec, _PARTS)
    for limb in LIMBS:
        for geom in (scratcher.TIP_GEOM, scratcher.ROD_GEOM):
            add_contact_sensor(
                spec,
                f"{geom}_{limb}",
                (mujoco.mjtObj.mjOBJ_GEOM, geom),
                (mujoco.mjtObj.mjOBJ_GEOM, f"right_{limb}"),
                fields=FOUND | FORCE | POS,
                count=1,
            )
    add_penetration_sensors(spec, (jaco.BASE_BODY, "right_shoulder"))
    add_contact_sensor(spec, "contact_tool", (mujoco.mjtObj.mjOBJ_BODY, "scratcher"), None)


def _add_pose_sensors(spec: mujoco.MjSpec) -> None:
    sensors = (
        ("tip_position", "position", scratcher.TIP_SITE),
        ("tip_rotation", "rotation", scratcher.TIP_SITE),
        ("end_effector_velocity", "velocity", jaco.END_EFFECTOR_SITE),
        *((f"itch_{limb}", "position", f"itch_{limb}") for limb in LIMBS),
        # A limb's body frame sits at the joint it hangs from.
        ("right_shoulder_joint", "position", "right_upper_arm"),
        ("right_elbow", "position", "right_forearm"),
        ("right_wrist", "position", "right_hand"),
    )
    add_frame_sensors(spec, sensors)

"""The scene: who stands where, and the sensors that observe contacts and poses."""

from __future__ import annotations

import mujoco

from rigid.tasks.bodies import human, jaco, scratcher, wheelchair
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters

CONTACTS_PER_PART = 6
"""Contacts kept for each body part; normal forces are summed, the strongest are kept."""
FRICTION = 0.25
"""Sliding friction of every contact: the original gives each link 0.5, and Bullet multiplies."""

_PARTS = human.ARM_PARTS + human.TRUNK_PARTS
CONTACT_TIME = 0.04
"""Time constant of contacts and limits [s]: MuJoCo's least at the original's physics step, stated
so that finer steps keep the same softness."""

LIMBS: tuple[human.Limb, ...] = ("forearm", "upper_arm")
"""Where it can itch; the human's one-hot itch feature has this order."""
_FOUND, _FORCE, _DIST, _POS = (
    1 << int(f)
    for f in (
        mujoco.mjtConDataField.mjCONDATA_FOUND,
        mujoco.mjtConDataField.mjCONDATA_FORCE,
        mujoco.mjtConDataField.mjCONDATA_DIST,
        mujoco.mjtConDataField.mjCONDATA_POS,
    )
)
_MIN_DISTANCE, _MAX_FORCE = 1, 2  # MuJoCo's reductions; `netforce` would cancel opposed contacts.


def build_spec(parameters: ItchScratchingParameters) -> mujoco.MjSpec:
    """Assembles wheelchair, person, arm and scratcher, with their sensors."""
    spec = mujoco.MjSpec()
    spec.modelname = "itch_scratching"
    spec.compiler.degree = False
    spec.option.timestep = parameters.physics_step
    spec.option.gravity = (0, 0, 0)  # As the original: every body floats once it is posed.
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # A runaway world must be seen, not silently put back to its defaults.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    spec.memory = 1 << 19
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
    for geom in spec.geoms:
        geom.solref[0] = CONTACT_TIME
        geom.friction[0] = FRICTION  # MuJoCo takes the larger of the two.
    for joint in spec.joints:
        joint.solref_limit[0] = CONTACT_TIME
    for limb in LIMBS:
        body, position, _ = human.itch_point(size, limb)
        spec.body(body).add_site(name=f"itch_{limb}", pos=position, size=(0.01, 0, 0))
    _add_contact_sensors(spec)
    _add_pose_sensors(spec)
    return spec


def _human_servo(strength: float) -> jaco.Servo:
    return jaco.Servo(1.7, 0.03, (strength,) * len(human.ARM_JOINTS))


def _add_contact_sensors(spec: mujoco.MjSpec) -> None:
    for part in _PARTS:
        sensor = spec.add_sensor(
            name=f"contact_{part}",
            type=mujoco.mjtSensor.mjSENS_CONTACT,
            objtype=mujoco.mjtObj.mjOBJ_XBODY,
            objname=jaco.BASE_BODY,
            reftype=mujoco.mjtObj.mjOBJ_BODY,
            refname=part,
        )
        sensor.intprm[:3] = (_FORCE, _MAX_FORCE, CONTACTS_PER_PART)
    for limb in LIMBS:
        for geom in (scratcher.TIP_GEOM, scratcher.ROD_GEOM):
            sensor = spec.add_sensor(
                name=f"{geom}_{limb}",
                type=mujoco.mjtSensor.mjSENS_CONTACT,
                objtype=mujoco.mjtObj.mjOBJ_GEOM,
                objname=geom,
                reftype=mujoco.mjtObj.mjOBJ_GEOM,
                refname=f"right_{limb}",
            )
            sensor.intprm[:3] = (_FOUND | _FORCE | _POS, _MAX_FORCE, 1)
    for root in (jaco.BASE_BODY, "right_shoulder"):
        sensor = spec.add_sensor(
            name=f"penetration_{root}",
            type=mujoco.mjtSensor.mjSENS_CONTACT,
            objtype=mujoco.mjtObj.mjOBJ_XBODY,
            objname=root,
        )
        sensor.intprm[:3] = (_DIST, _MIN_DISTANCE, 1)
    sensor = spec.add_sensor(
        name="contact_tool",
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=mujoco.mjtObj.mjOBJ_BODY,
        objname="scratcher",
    )
    sensor.intprm[:3] = (_FORCE, _MAX_FORCE, CONTACTS_PER_PART)


def _add_pose_sensors(spec: mujoco.MjSpec) -> None:
    site, body = mujoco.mjtObj.mjOBJ_SITE, mujoco.mjtObj.mjOBJ_XBODY
    position, rotation = mujoco.mjtSensor.mjSENS_FRAMEPOS, mujoco.mjtSensor.mjSENS_FRAMEQUAT
    velocity = mujoco.mjtSensor.mjSENS_FRAMELINVEL
    for name, kind, object_type, object_name in (
        ("tip_position", position, site, scratcher.TIP_SITE),
        ("tip_rotation", rotation, site, scratcher.TIP_SITE),
        ("end_effector_velocity", velocity, site, jaco.END_EFFECTOR_SITE),
        *((f"itch_{limb}", position, site, f"itch_{limb}") for limb in LIMBS),
        # A limb's body frame sits at the joint it hangs from.
        ("right_shoulder_joint", position, body, "right_upper_arm"),
        ("right_elbow", position, body, "right_forearm"),
        ("right_wrist", position, body, "right_hand"),
    ):
        spec.add_sensor(name=name, type=kind, objtype=object_type, objname=object_name)

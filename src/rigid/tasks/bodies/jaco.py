"""Kinova Jaco j2s7s300: the 7-joint arm with its three fingers closed, from published kinematics.

Primitive shapes are fitted to the bounding boxes of the published link meshes. Joint origins,
limits and masses are those of the manufacturer's robot description.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np

from rigid.tasks.bodies.collision import Role, assign

JOINT_NAMES = tuple(f"jaco_joint_{i}" for i in range(1, 8))
BASE_BODY = "jaco_base"
HAND_BODY = "jaco_link_7"
END_EFFECTOR_SITE = "jaco_end_effector"

_RGBA = (0.28, 0.30, 0.34, 1.0)
_RGBA_ACCENT = (0.62, 0.64, 0.68, 1.0)


@dataclass(frozen=True)
class _Link:
    """One moving link: its joint, its mass and the capsule that stands for its shape."""

    origin: tuple[float, float, float]  # [m], in the parent link's frame.
    rpy: tuple[float, float, float]  # [rad], fixed-axis roll, pitch, yaw.
    limits: tuple[float, float]  # [rad]
    mass: float  # [kg]
    center_of_mass: tuple[float, float, float]  # [m]
    inertia: tuple[float, float, float]  # [kg m²], diagonal about the centre of mass.
    capsule: tuple[float, float, float, float, float, float]  # [m], axis end points.
    radius: float  # [m]
    role: Role


_TURN = 2 * np.pi
_LINKS = (
    _Link((0, 0, 0.15675), (0, np.pi, 0), (-_TURN, _TURN), 0.7477, (0, -0.002, -0.0605),
          (2.2e-3, 2.2e-3, 1.0e-3), (0, 0, -0.119, 0, 0, -0.041), 0.041, Role.ROBOT),
    _Link((0, 0.0016, -0.11875), (-np.pi / 2, 0, np.pi), (0.8203, 5.4629), 0.8447,
          (0, -0.1036, 0), (5.1e-3, 1.1e-3, 5.0e-3), (0, -0.164, 0, 0, 0, 0), 0.041, Role.ROBOT),
    _Link((0, -0.205, 0), (-np.pi / 2, 0, 0), (-_TURN, _TURN), 0.8447, (0, 0, -0.1022),
          (5.1e-3, 5.0e-3, 1.1e-3), (0, 0, -0.205, 0, 0, -0.041), 0.041, Role.ROBOT),
    _Link((0, 0, -0.205), (np.pi / 2, 0, np.pi), (0.5236, 5.7596), 0.6763, (0, 0.081, -0.0086),
          (3.9e-3, 0.7e-3, 4.1e-3), (0, 0, -0.002, 0, 0.168, -0.01), 0.039, Role.ROBOT),
    _Link((0, 0.2073, -0.0114), (-np.pi / 2, 0, np.pi), (-_TURN, _TURN), 0.463,
          (0, 0.0029, -0.0542), (1.0e-3, 1.0e-3, 0.5e-3), (0, 0, -0.103, 0, 0, -0.032), 0.032,
          Role.WRIST),
    _Link((0, 0, -0.10375), (np.pi / 2, 0, np.pi), (1.1345, 5.1487), 0.463, (0, 0.0497, -0.0029),
          (1.0e-3, 0.5e-3, 1.0e-3), (0, 0, 0, 0, 0.072, 0), 0.032, Role.WRIST),
    _Link((0, 0.10375, 0), (-np.pi / 2, 0, np.pi), (-_TURN, _TURN), 0.990, (0, 0, -0.06),
          (2.3e-3, 2.1e-3, 1.8e-3), (0, 0, -0.075, 0, 0, -0.046), 0.046, Role.WRIST),
)  # fmt: skip

# Where the fingers leave the palm, in the hand's frame [m].
_FINGER_ROOTS = (
    (0.00279, 0.03126, -0.11467),
    (0.02226, -0.02707, -0.11482),
    (-0.02226, -0.02707, -0.11482),
)


@dataclass(frozen=True)
class Servo:
    """A velocity servo as a MuJoCo position actuator: torque = gain·(rate·(target - q) - q̇).

    The original drives every joint at `rate` times the distance to its target, with the torque
    capped. A high `gain` makes light joints oscillate at a 0.02 s step, hence the armature.
    """

    RATE = 2.5  # [1/s], Assistive Gym's position gain (0.05) over its time step.

    gain: float  # [N·m·s/rad]
    armature: float  # [kg·m²]
    torque_caps: tuple[float, ...]  # [N·m], one for each joint, base first.
    rate: float = RATE  # [1/s]


def robot_servo(profile: Literal["paper", "datasheet"], rate: float = Servo.RATE) -> Servo:
    """The arm's servo: `paper` caps every joint at 1 N·m, `datasheet` at Kinova's peak torques."""
    if profile == "paper":
        return Servo(1.7, 0.03, (1.0,) * 7, rate)
    # Kinova's data sheet: 30.5 N·m for the four large actuators, 6.8 N·m for the wrist.
    # The higher gain asks for up to 6.25 N·m; one of 30 swings at steps of 0.02 s.
    return Servo(10.0, 0.03, (30.5,) * 4 + (6.8,) * 3, rate)


def quaternion(rpy: tuple[float, float, float]) -> np.ndarray:
    """Quaternion [w, x, y, z] of fixed-axis roll, pitch, yaw in [rad]."""
    half = np.asarray(rpy) / 2
    (cr, cp, cy), (sr, sp, sy) = np.cos(half), np.sin(half)
    return np.array([
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    ])  # fmt: skip


def add_servo(spec: mujoco.MjSpec, joint: mujoco.MjsJoint, servo: Servo, cap: float) -> None:
    """Adds the position actuator that drives `joint`; its control is the target angle [rad]."""
    joint.armature = servo.armature
    actuator = spec.add_actuator(name=f"{joint.name}_servo", target=joint.name)
    actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
    stiffness = servo.rate * servo.gain
    actuator.set_to_position(kp=stiffness, kv=servo.gain)
    actuator.forcelimited = True
    actuator.forcerange = (-cap, cap)


def add_jaco(
    spec: mujoco.MjSpec,
    *,
    position: tuple[float, float, float],
    yaw: float,
    servo: Servo,
) -> mujoco.MjsBody:
    """Adds the arm with a fixed base and its servos; returns the hand, to which tools attach."""
    body = spec.worldbody.add_body(name=BASE_BODY, pos=position, quat=quaternion((0, 0, yaw)))
    body.add_geom(
        name="jaco_base_column",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=(0.041, 0.0785, 0),
        pos=(0, 0, 0.0785),
        rgba=_RGBA_ACCENT,
        contype=0,
        conaffinity=0,
    )
    for number, link in enumerate(_LINKS, start=1):
        body = body.add_body(
            name=f"jaco_link_{number}",
            pos=link.origin,
            quat=quaternion(link.rpy),
            mass=link.mass,
            ipos=link.center_of_mass,
            inertia=link.inertia,
            explicitinertial=True,
        )
        joint = body.add_joint(
            name=f"jaco_joint_{number}", axis=(0, 0, 1), range=link.limits, limited=True
        )
        geom = body.add_geom(
            name=f"jaco_link_{number}",
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=link.capsule,
            size=(link.radius, 0, 0),
            rgba=_RGBA if number % 2 else _RGBA_ACCENT,
        )
        assign(geom, link.role)
        add_servo(spec, joint, servo, servo.torque_caps[number - 1])
    _add_fingers(body)
    body.add_site(name=END_EFFECTOR_SITE, pos=(0, 0, -0.16), quat=quaternion((np.pi, 0, 0)))
    return body


def _add_fingers(hand: mujoco.MjsBody) -> None:
    """Three fingers held closed around the tool: they never move during an episode."""
    for number, root in enumerate(_FINGER_ROOTS, start=1):
        tip = (0.35 * root[0], 0.35 * root[1], -0.165)
        geom = hand.add_geom(
            name=f"jaco_finger_{number}",
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=(*root, *tip),
            size=(0.012, 0, 0),
            rgba=_RGBA,
        )
        assign(geom, Role.WRIST)

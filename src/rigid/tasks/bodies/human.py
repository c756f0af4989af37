"""Seated human of capsules with a 10-joint right arm; everything else is fixed to the chair.

Sizes, joint limits and mass fractions follow Assistive Gym's capsule human. Limbs hang along -z of
their link frame at zero angles. Departures, all ours: centres of mass lie in the middle of each
shape (the original puts them at the joint), and the pose-dependent limit of the shoulder (a small
network asked after every physics step) is left out, so an adversary reaches somewhat more of the
joint space; near the seated pose that network never bites.
"""

from __future__ import annotations

from typing import Literal

import mujoco
import numpy as np

from rigid.tasks.bodies.collision import Role, assign
from rigid.tasks.bodies.jaco import Servo, add_servo
from rigid.tasks.bodies.sizes import BodySize

Limb = Literal["forearm", "upper_arm"]

ARM_JOINTS = (
    "pecs_x", "pecs_y", "pecs_z", "shoulder_x", "shoulder_y", "shoulder_z",
    "elbow", "forearm_roll", "wrist_x", "wrist_y",
)  # fmt: skip
"""The controllable joints, in the order of the human's action."""

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
# Names and axes disagree in the original: "shoulder_x" (abduction) turns about y.
_JOINT_AXIS_AND_LIMITS_DEG = {
    "pecs_x": ("x", -10.0, 10.0),
    "pecs_y": ("y", -10.0, 30.0),
    "pecs_z": ("z", -35.0, 35.0),
    "shoulder_x": ("y", 5.0, 198.0),
    "shoulder_y": ("x", -188.0, 61.0),
    "shoulder_z": ("z", -90.0, 90.0),
    "elbow": ("x", -128.0, 0.0),
    "forearm_roll": ("z", -90.0, 90.0),
    "wrist_x": ("x", -81.0, 90.0),
    "wrist_y": ("y", -27.0, 47.0),
}
SEATED_POSE_DEG = {"shoulder_x": 30.0, "elbow": -90.0}
"""Start angles of the right arm; joints that are not named start at 0."""

TRUNK_PARTS = ("torso", "head", "legs", "right_shoulder")
"""Bodies that no robot should touch: everything but the arms."""
RESTING_PARTS = ("torso", "legs", "left_arm", "right_arm")
"""Bodies of a person of whom only the head moves, without it."""
ARM_PARTS = ("right_upper_arm", "right_forearm", "right_hand", "left_arm")

SKIN = (0.86, 0.68, 0.56, 1.0)
_SHIRT = (0.45, 0.56, 0.67, 1.0)
_TROUSERS = (0.34, 0.37, 0.45, 1.0)


# Shares of the body mass carried by the moving links (Assistive Gym).
_MASS_SHARE = {"pecs": 0.05, "upper_arm": 0.033, "forearm": 0.019, "hand": 0.0065}


def arm_limits(scale: float) -> np.ndarray:
    """Joint limits [rad] of the right arm, shape (10, 2), times `scale` in (0, 1]."""
    degrees = np.array([_JOINT_AXIS_AND_LIMITS_DEG[name][1:] for name in ARM_JOINTS])
    limits: np.ndarray = np.deg2rad(degrees) * scale
    start = start_angles()
    return np.stack([np.minimum(limits[:, 0], start), np.maximum(limits[:, 1], start)], axis=1)


def start_angles() -> np.ndarray:
    """Right-arm angles [rad] of the seated pose, shape (10,)."""
    angles = []
    for name in ARM_JOINTS:
        _, lower, upper = _JOINT_AXIS_AND_LIMITS_DEG[name]
        angles.append(np.clip(SEATED_POSE_DEG.get(name, 0.0), lower, upper))
    return np.deg2rad(angles)


def add_seated_human(
    spec: mujoco.MjSpec, size: BodySize, *, servo: Servo, limit_scale: float = 1.0
) -> None:
    """Adds the seated body: fixed torso, head, legs and left arm; right arm with 10 servos.

    Args:
        spec: The scene under construction.
        size: Lengths and mass of the body.
        servo: Drive of the arm; its torque caps are in the order of `ARM_JOINTS`.
        limit_scale: Impairment `limits`: factor on the arm's joint range, in (0, 1].
    """
    chest = chest_origin(size)
    _add_torso(spec, size, chest)
    head = spec.worldbody.add_body(name="head")
    neck = chest + (0, 0, size.neck[3])
    add_neck(head, size, neck, Role.TRUNK)
    skull = head.add_geom(
        name="head",
        type=mujoco.mjtGeom.mjGEOM_ELLIPSOID,
        size=size.head[:3],
        pos=neck + (0, 0, size.head[3]) + (0, *size.head_center),  # Of the original's head mesh.
        rgba=SKIN,
        mass=0.0,
    )
    assign(skull, Role.TRUNK)
    _add_legs(spec, size, chest)
    _add_still_arm(spec, size, chest, "left", 1)
    _add_right_arm(spec, size, chest, servo, arm_limits(limit_scale))


def add_resting_body(spec: mujoco.MjSpec, size: BodySize) -> None:
    """Adds the seated body without its head, all of it fixed: `RESTING_PARTS`."""
    chest = chest_origin(size)
    _add_torso(spec, size, chest)
    radius, length, out = size.pecs
    right = _across(chest + (-out, 0, size.pecs_up), length)
    _capsule(spec.body("torso"), "right_pecs", right, radius, Role.TRUNK, _SHIRT)
    _add_legs(spec, size, chest)
    _add_still_arm(spec, size, chest, "left", 1)
    _add_still_arm(spec, size, chest, "right", -1)


def chest_origin(size: BodySize) -> np.ndarray:
    """Where the chest is [m], world frame: the frame in which the human sees."""
    return np.array([0.0, 0.03, size.chest_height])


def add_neck(
    body: mujoco.MjsBody, size: BodySize, joint: np.ndarray, role: Role, share: float = 0.0
) -> None:
    """Adds the neck's capsule above its `joint` [m], in the frame of `body`.

    Args:
        body: Of the neck.
        size: Of the person.
        joint: Where the neck leaves the trunk.
        role: Whom it may touch.
        share: Of the body's mass; 0 where it does not move.
    """
    radius, length, center, _ = size.neck
    up = np.array([0, 0, 1.0])
    middle = joint + center * up
    ends = (middle - length / 2 * up, middle + length / 2 * up)
    _capsule(body, "neck", ends, radius, role, SKIN).mass = share * size.mass


def _capsule(
    body: mujoco.MjsBody,
    name: str,
    ends: tuple[np.ndarray, np.ndarray],
    radius: float,
    role: Role,
    rgba: tuple[float, float, float, float],
) -> mujoco.MjsGeom:
    same = np.allclose(*ends)
    geom = body.add_geom(name=name, rgba=rgba, mass=0.0)
    if same:
        geom.type, geom.pos, geom.size = mujoco.mjtGeom.mjGEOM_SPHERE, ends[0], (radius, 0, 0)
    else:
        geom.type, geom.size = mujoco.mjtGeom.mjGEOM_CAPSULE, (radius, 0, 0)
        geom.fromto = np.concatenate(ends)
    assign(geom, role)
    return geom


def _across(center: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    half = np.array([length / 2, 0, 0])
    return center - half, center + half


def _add_torso(spec: mujoco.MjSpec, size: BodySize, chest: np.ndarray) -> None:
    torso = spec.worldbody.add_body(name="torso")
    up = np.array([0, 0, 1.0])
    _capsule(torso, "chest", _across(chest, size.chest[1]), size.chest[0], Role.TRUNK, _SHIRT)
    radius, length, out = size.pecs
    left = chest + (out, 0, size.pecs_up)
    _capsule(torso, "left_pecs", _across(left, length), radius, Role.TRUNK, _SHIRT)
    waist = chest - size.waist[2] * up
    _capsule(torso, "waist", _across(waist, size.waist[1]), size.waist[0], Role.TRUNK, _SHIRT)
    hips = waist - 2 * size.hips[2] * up
    _capsule(torso, "hips", _across(hips, size.hips[1]), size.hips[0], Role.TRUNK, _TROUSERS)


def _add_legs(spec: mujoco.MjSpec, size: BodySize, chest: np.ndarray) -> None:
    """Seated legs: hips flexed by 90°, knees by 80°."""
    legs = spec.worldbody.add_body(name="legs")
    hip_height = size.waist[2] + 2 * size.hips[2]
    shin_axis = np.array([0, -np.sin(np.deg2rad(10)), -np.cos(np.deg2rad(10))])
    for side, sign in (("right", -1), ("left", 1)):
        hip = chest + (sign * size.hip_out, 0, -hip_height)
        knee = hip + (0, -size.thigh[1], 0)
        ankle = knee + (size.shin[1] + size.shin[0] / 2) * shin_axis
        heel, toe = ankle + (0, 0.0, -0.025), ankle + (0, -size.foot[1], -0.025)
        _capsule(legs, f"{side}_thigh", (hip, knee), size.thigh[0], Role.TRUNK, _TROUSERS)
        _capsule(legs, f"{side}_shin", (knee, ankle), size.shin[0], Role.TRUNK, _TROUSERS)
        _capsule(legs, f"{side}_foot", (heel, toe), size.foot[0], Role.TRUNK, _TROUSERS)


def _add_still_arm(
    spec: mujoco.MjSpec, size: BodySize, chest: np.ndarray, side: str, sign: int
) -> None:
    """An arm at rest: abducted by 5°, elbow bent by 90°, forearm forward."""
    arm = spec.worldbody.add_body(name=f"{side}_arm")
    shoulder = chest + (sign * size.shoulder_out, 0, 2 * size.pecs_up)
    tilt = np.deg2rad(5.0)
    down = np.array([sign * np.sin(tilt), 0, -np.cos(tilt)])
    elbow = shoulder + size.upper_arm[1] * down
    wrist = elbow + (0, -(size.forearm[1] + size.forearm[0]), 0)
    upper = (shoulder, elbow)
    _capsule(arm, f"{side}_upper_arm", upper, size.upper_arm[0], Role.TRUNK, SKIN)
    _capsule(arm, f"{side}_forearm", (elbow, wrist), size.forearm[0], Role.TRUNK, SKIN)
    hand = wrist + (0, -size.hand, 0)
    _capsule(arm, f"{side}_hand", (hand, hand), size.hand, Role.TRUNK, SKIN)


def _add_right_arm(
    spec: mujoco.MjSpec, size: BodySize, chest: np.ndarray, servo: Servo, limits: np.ndarray
) -> None:
    """Right shoulder girdle, upper arm, forearm and hand, each a body with its joints."""
    down = np.array([0, 0, -1.0])
    wrist_drop = size.forearm[1] + size.forearm[0]
    chain = (
        # Body, its place in the parent, its joints, its capsule, role, share of mass.
        ("right_shoulder", chest + (0, 0, size.pecs_up), ARM_JOINTS[0:3],
         _across(np.array([-size.pecs[2], 0, 0]), size.pecs[1]), size.pecs[0], Role.SHOULDER,
         "pecs"),
        ("right_upper_arm", np.array([-size.shoulder_out, 0, size.pecs_up]), ARM_JOINTS[3:6],
         (0 * down, size.upper_arm[1] * down), size.upper_arm[0], Role.ARM, "upper_arm"),
        ("right_forearm", size.upper_arm[1] * down, ARM_JOINTS[6:8],
         (0 * down, size.forearm[1] * down), size.forearm[0], Role.ARM, "forearm"),
        ("right_hand", wrist_drop * down, ARM_JOINTS[8:10],
         (size.hand * down, size.hand * down), size.hand, Role.ARM, "hand"),
    )  # fmt: skip
    parent = spec.worldbody
    start, index = start_angles(), 0
    for name, position, joints, ends, radius, role, share in chain:
        parent = parent.add_body(name=name, pos=position)
        for joint_name in joints:
            axis = _AXES[_JOINT_AXIS_AND_LIMITS_DEG[joint_name][0]]
            joint = parent.add_joint(
                name=joint_name, axis=axis, range=limits[index], limited=True, ref=0.0
            )
            add_servo(spec, joint, servo, servo.torque_caps[index])
            index += 1
        rgba = _SHIRT if role is Role.SHOULDER else SKIN
        geom = _capsule(parent, name, ends, radius, role, rgba)
        geom.mass = _MASS_SHARE[share] * size.mass
    assert index == len(start)


def itch_point(size: BodySize, limb: Limb) -> tuple[str, np.ndarray, np.ndarray]:
    """Body, position and outward normal [m] of the itch in the middle of `limb`, on its outer side.

    The paper fixes one point on the forearm and one on the upper arm and leaves the side open;
    ours is the lateral side, which faces the robot and which both bodies can bring together.
    """
    radius, length = size.forearm if limb == "forearm" else size.upper_arm
    outward = np.array([-1.0, 0.0, 0.0])
    return f"right_{limb}", np.array([0, 0, -length / 2]) + radius * outward, outward

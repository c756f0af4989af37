"""The human on their back on a bed: the seated one laid down, with straight legs and arms.

Head, trunk and the moving right arm are those of `rigid.tasks.bodies.human`, turned by 90° about
the chest: the face looks up, the head points to +y, and the person's right stays at -x.
"""

from __future__ import annotations

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bodies import human
from rigid.tasks.bodies.bed import MATTRESS_TOP
from rigid.tasks.bodies.collision import Role, assign
from rigid.tasks.bodies.jaco import Servo
from rigid.tasks.bodies.sizes import BodySize

LAID_DOWN = Rotation.from_euler("x", -np.pi / 2)
"""Turns the seated person's frame into the lying one's (Assistive Gym)."""
ABDUCTION_DEG = 30.0
"""Of the right arm (Assistive Gym)."""
PARTS = human.TRUNK_PARTS + human.ARM_PARTS
"""Bodies of the person."""

_CHEST_AT = (-0.15, 0.2)
"""Chest on the bed, x and y [m]. The original has x at -0.15, where the hand lies beyond the edge
of the mattress: it hangs down there, and rests on the bed here."""
_SINK = 0.04
"""How deep the hips lie in the mattress [m]. Ours: the original's is hard, and wavy."""
_CLEAR = 0.002
"""Between the mattress and what begins on it [m]. Ours: nothing is pressed at the start."""
_LEFT_ABDUCTION_DEG = 5.0  # The joint's limit, as in the original.
_TROUSERS = (0.34, 0.37, 0.45, 1.0)


def chest_origin(size: BodySize) -> Float[np.ndarray, "3"]:
    """Where the chest is [m], world frame: the frame in which the human sees."""
    return np.array([*_CHEST_AT, MATTRESS_TOP + size.hips[0] - _SINK])


def start_angles(size: BodySize) -> Float[np.ndarray, "10"]:
    """Angles [rad] of the right arm: straight, abducted, the hand on the mattress."""
    angles = dict.fromkeys(human.ARM_JOINTS, 0.0)
    angles["shoulder_x"] = np.deg2rad(ABDUCTION_DEG)
    angles["shoulder_y"] = _lowered(size)
    return np.array([angles[name] for name in human.ARM_JOINTS])


def arm_limits(size: BodySize, scale: float) -> Float[np.ndarray, "10 2"]:
    """Joint limits [rad] of the right arm times `scale` in (0, 1]; the start lies within."""
    low, high = human.arm_limits(1.0).T * scale
    start = start_angles(size)
    return np.stack([np.minimum(low, start), np.maximum(high, start)], axis=1)


def add_lying_human(
    spec: mujoco.MjSpec, size: BodySize, *, servo: Servo, limit_scale: float = 1.0
) -> None:
    """Adds the lying body: all of it fixed but the right arm with its 10 servos.

    Args:
        spec: The scene under construction.
        size: Lengths and mass of the body.
        servo: Drive of the arm; its torque caps are in the order of `human.ARM_JOINTS`.
        limit_scale: Impairment `limits`: factor on the arm's joint range, in (0, 1].
    """
    human.add_seated_human(spec, size, servo=servo)
    for part in ("legs", "left_arm"):
        spec.delete(spec.body(part))
    _add_legs(spec, size)
    _add_left_arm(spec, size)
    seat, chest = human.chest_origin(size), chest_origin(size)
    for name in ("torso", "head", "legs", "left_arm", "right_shoulder"):
        body = spec.body(name)
        body.pos = chest + LAID_DOWN.apply(np.array(body.pos) - seat)
        body.quat = LAID_DOWN.as_quat(scalar_first=True)
    limits = arm_limits(size, limit_scale)
    for name, range_ in zip(human.ARM_JOINTS, limits, strict=True):
        spec.joint(name).range = range_


def _lowered(size: BodySize) -> float:
    """How far a straight arm is turned back [rad], so that its hand lies on the mattress."""
    length = size.upper_arm[1] + size.forearm[1] + size.forearm[0] + size.hand
    return _fall(size, length, size.hand)


def _fall(size: BodySize, length: float, radius: float) -> float:
    """Turn back [rad] of a limb from the chest's height, whose end of `radius` then lies down."""
    drop = chest_origin(size)[2] - (MATTRESS_TOP + radius + _CLEAR)
    return float(np.arcsin(drop / length))


def _add_legs(spec: mujoco.MjSpec, size: BodySize) -> None:
    """Straight legs, the feet up; in the frame of a person who stands where the seated one sits."""
    legs, chest = spec.worldbody.add_body(name="legs"), human.chest_origin(size)
    length = size.thigh[1] + size.shin[1] + size.shin[0] / 2
    back = _fall(size, length, size.shin[0])
    down, ahead = np.array([0, np.sin(back), -np.cos(back)]), np.array([0, -1.0, 0])
    for side, sign in (("right", -1), ("left", 1)):
        hip = chest + (sign * size.hip_out, 0, -(size.waist[2] + 2 * size.hips[2]))
        knee, ankle = hip + size.thigh[1] * down, hip + length * down
        heel = ankle + 0.025 * down
        for name, ends, radius in (
            ("thigh", (hip, knee), size.thigh[0]),
            ("shin", (knee, ankle), size.shin[0]),
            ("foot", (heel, heel + size.foot[1] * ahead), size.foot[0]),
        ):
            _add_capsule(legs, f"{side}_{name}", ends, radius, _TROUSERS)


def _add_left_arm(spec: mujoco.MjSpec, size: BodySize) -> None:
    """The straight left arm at the person's side."""
    arm, chest = spec.worldbody.add_body(name="left_arm"), human.chest_origin(size)
    shoulder = chest + (size.shoulder_out, 0, 2 * size.pecs_up)
    turn = Rotation.from_euler("YX", (-np.deg2rad(_LEFT_ABDUCTION_DEG), _lowered(size)))
    down = turn.apply((0, 0, -1.0))
    elbow = shoulder + size.upper_arm[1] * down
    wrist = elbow + (size.forearm[1] + size.forearm[0]) * down
    hand = wrist + size.hand * down
    for name, ends, radius in (
        ("left_upper_arm", (shoulder, elbow), size.upper_arm[0]),
        ("left_forearm", (elbow, wrist), size.forearm[0]),
        ("left_hand", (hand, hand + 1e-3 * down), size.hand),
    ):
        _add_capsule(arm, name, ends, radius, human.SKIN)


def _add_capsule(
    body: mujoco.MjsBody,
    name: str,
    ends: tuple[np.ndarray, np.ndarray],
    radius: float,
    rgba: tuple[float, float, float, float],
) -> None:
    geom = body.add_geom(
        name=name, type=mujoco.mjtGeom.mjGEOM_CAPSULE, size=(radius, 0, 0),
        fromto=np.concatenate(ends), rgba=rgba, mass=0.0,
    )  # fmt: skip
    assign(geom, Role.TRUNK)

"""A made-up person and a made-up robot arm that move: material for the report's tests, no physics.

The robot follows the itch with a delay; the adversary is the same arm motion with a sweep of given
harm on top. Contacts and forces come from overlaps of capsules, so they agree with the picture.
"""

from __future__ import annotations

import numpy as np

from rigid.report import encode_poses

FRAMES = 101
DT = 0.1  # [s]

LINKS = (0.16, 0.21, 0.21, 0.21, 0.21, 0.11, 0.11)  # [m]
LINK_RADII = (0.05, 0.045, 0.042, 0.04, 0.034, 0.032, 0.036)
TOOL = 0.16
BASE = np.array([-0.62, -0.12, 0.58])
SHOULDER = np.array([-0.21, 0.02, 1.06])
UPPER_ARM, FOREARM, HAND = 0.27, 0.24, 0.09
LIMB_RADII = {"upper arm": 0.045, "forearm": 0.036}
ITCH_SIDE = 0.7  # How far along the limb the itch sits.

BODIES = (
    "world", "jaco_base", *(f"jaco_link_{i}" for i in range(1, 8)), "tool", "tool_tip",
    "human_upper_arm", "human_forearm", "human_hand",
)  # fmt: skip
MOVING = list(range(2, len(BODIES)))
_BODY = {name: index for index, name in enumerate(BODIES)}


def scene() -> dict:
    """Geoms of robot, person, chair; bodies that move have their z axis along the limb."""
    geoms = []

    def add(name, body, kind, size, pos, role, rgba, quat=(1.0, 0.0, 0.0, 0.0)):
        geoms.append({
            "name": name, "body": _BODY[body], "type": kind, "size": list(size),
            "pos": list(pos), "quat": list(quat), "rgba": list(rgba), "role": role,
        })  # fmt: skip

    dark, light = (0.28, 0.30, 0.34, 1.0), (0.62, 0.64, 0.68, 1.0)
    skin, cloth, steel = (0.85, 0.67, 0.55, 1.0), (0.45, 0.55, 0.65, 1.0), (0.7, 0.7, 0.7, 1.0)
    add("robot_base", "jaco_base", "cylinder", (0.07, 0.06), (0, 0, -0.06), "robot", dark)
    for i, (length, radius) in enumerate(zip(LINKS, LINK_RADII, strict=True), 1):
        rgba = light if i % 2 else dark
        size = (radius, length / 2)
        add(f"link_{i}", f"jaco_link_{i}", "capsule", size, (0, 0, 0), "robot", rgba)
    add("rod", "tool", "cylinder", (0.008, TOOL / 2), (0, 0, 0), "tool", dark)
    add("tip", "tool_tip", "sphere", (0.013,), (0, 0, 0), "tool", dark)
    for name, body, length in (
        ("upper arm", "human_upper_arm", UPPER_ARM), ("forearm", "human_forearm", FOREARM),
    ):  # fmt: skip
        size = (LIMB_RADII[name], length / 2)
        add(name, body, "capsule", size, (0, 0, 0), "human", skin)
    add("hand", "human_hand", "ellipsoid", (0.035, 0.018, 0.06), (0, 0, 0), "human", skin)
    add("head", "world", "ellipsoid", (0.085, 0.1, 0.12), (0, -0.02, 1.36), "human", skin)
    add("neck", "world", "capsule", (0.05, 0.04), (0, 0.01, 1.18), "human", skin)
    add("chest", "world", "box", (0.17, 0.09, 0.2), (0, 0.04, 0.94), "human", cloth)
    across = (0.7071, 0.0, 0.7071, 0.0)
    add("shoulders", "world", "capsule", (0.06, 0.17), (0, 0.03, 1.08), "human", cloth, across)
    forward = (0.7071, 0.7071, 0.0, 0.0)
    for side, x in (("right", -0.1), ("left", 0.1)):
        thigh = (x, -0.2, 0.6)
        add(f"{side} thigh", "world", "capsule", (0.07, 0.19), thigh, "human", cloth, forward)
        add(f"{side} shin", "world", "capsule", (0.05, 0.19), (x, -0.44, 0.36), "human", cloth)
        hub = (3.2 * x, 0.05, 0.3)
        add(f"{side} wheel", "world", "cylinder", (0.3, 0.015), hub, "chair", steel, across)
    add("left arm", "world", "capsule", (0.045, 0.13), (0.24, 0.0, 0.92), "human", skin)
    add("seat", "world", "box", (0.22, 0.22, 0.03), (0, -0.05, 0.49), "chair", steel)
    add("back", "world", "box", (0.2, 0.02, 0.3), (0, 0.17, 0.8), "chair", steel)
    rest = [[0, 0, 0, 1, 0, 0, 0] for _ in BODIES]
    rest[_BODY["jaco_base"]][:3] = BASE
    return {"bodies": list(BODIES), "geoms": geoms, "rest": rest}


def _unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def _z_to(direction):
    """Quaternion w, x, y, z that turns the z axis to a unit direction."""
    quaternion = np.array([1 + direction[2], -direction[1], direction[0], 0.0])
    if np.linalg.norm(quaternion) < 1e-6:
        return np.array([0.0, 1.0, 0.0, 0.0])
    return _unit(quaternion)


def _arm(harm, rng):
    """Elbow, wrist, fingertips per frame; `harm` 0..1 sweeps the arm towards the robot."""
    t = np.linspace(0, 1, FRAMES)[:, None]
    phase, pace = rng.uniform(0, 2 * np.pi), 1.2 + rng.uniform(0, 0.4)
    sway = 0.07 * np.sin(2 * np.pi * pace * t + phase)
    burst = harm * np.exp(-(((t - 0.55) / 0.16) ** 2))
    jerk = burst * np.sin(2 * np.pi * (3.2 * t + phase))
    upper = _unit(np.hstack([
        -0.42 - 0.9 * burst, -0.62 + sway + 0.3 * jerk, -0.68 + 0.55 * burst,
    ]))  # fmt: skip
    lower = _unit(np.hstack([
        -0.18 - 0.7 * burst - 0.3 * jerk, -0.92 + 0.2 * jerk,
        0.12 + 2 * sway - 0.4 * burst + 0.5 * jerk,
    ]))  # fmt: skip
    elbow = SHOULDER + UPPER_ARM * upper
    wrist = elbow + FOREARM * lower
    return elbow, wrist, wrist + HAND * lower, upper, lower


def _reach(joints, target):
    """FABRIK: joint positions of a chain from BASE whose end comes near `target`."""
    lengths = np.array([*LINKS, TOOL])
    joints = joints.copy()
    for _ in range(2):
        joints[-1] = target
        for i in range(len(lengths) - 1, 0, -1):
            joints[i] = joints[i + 1] + lengths[i] * _unit(joints[i] - joints[i + 1])
        joints[0] = BASE
        joints[1] = BASE + [0, 0, lengths[0]]  # The first link is a column.
        for i in range(1, len(lengths)):
            joints[i + 1] = joints[i] + lengths[i] * _unit(joints[i + 1] - joints[i])
    return joints


def _deepest(joints, limbs):
    """The deepest overlap of an arm link with a limb [m], where on the link, and their bodies."""
    shares = np.array([0.25, 0.75])[:, None, None]
    points = (joints[3:-1] + shares * (joints[4:] - joints[3:-1])).reshape(-1, 1, 3)
    radii = np.tile([*LINK_RADII[3:], 0.008], 2)[:, None]
    start, end = limbs[:, 0], limbs[:, 1]
    axis = end - start
    along = np.clip(((points - start) * axis).sum(-1) / (axis * axis).sum(-1), 0, 1)
    gap = np.linalg.norm(points - start - along[..., None] * axis, axis=-1)
    depth = radii + np.array([0.045, 0.036, 0.036]) - gap
    link, limb = np.unravel_index(depth.argmax(), depth.shape)
    bodies = MOVING[3 + link % (len(points) // 2)], MOVING[len(LINKS) + 2 + limb]
    return max(0.0, float(depth.max())), points[link, 0], bodies


def episode(seed: int, harm: float) -> dict:
    """One replay `R`. The same seed has the same start, whatever the harm."""
    rng = np.random.default_rng(seed)
    elbow, wrist, tips, upper, lower = _arm(harm, rng)
    limb = "forearm" if seed % 2 else "upper arm"
    body = f"human_{limb}".replace(" ", "_")
    length = FOREARM if limb == "forearm" else UPPER_ARM
    out = np.array([-LIMB_RADII[limb], 0.0, (ITCH_SIDE - 0.5) * length])

    joints = np.linspace(BASE, BASE + [-0.15, -0.4, 0.75], len(LINKS) + 2)
    joints[3:6] += [-0.25, -0.1, 0.1]
    goal = np.array([-0.62, -0.62, 1.18])
    poses = np.zeros((FRAMES, len(MOVING), 7))
    forces, itch_forces, distances, counted, contacts = [], [], [], [], []
    for f in range(FRAMES):
        limbs = {
            "human_upper_arm": (SHOULDER, elbow[f], upper[f]),
            "human_forearm": (elbow[f], wrist[f], lower[f]),
            "human_hand": (wrist[f], tips[f], lower[f]),
        }
        a, b, axis = limbs[body]
        itch = (a + b) / 2 + _rotate(_z_to(axis), out)
        wobble = 0.02 * np.array([np.sin(f * 0.9), np.cos(f * 0.7), np.sin(f * 0.5)])
        goal = goal + 0.13 * (itch + wobble - goal)
        joints = _reach(joints, goal)
        for i in range(len(LINKS) + 1):
            poses[f, i, :3] = (joints[i] + joints[i + 1]) / 2
            poses[f, i, 3:] = _z_to(_unit(joints[i + 1] - joints[i]))
        poses[f, len(LINKS) + 1] = [*joints[-1], *poses[f, len(LINKS), 3:]]
        for i, (p, q, direction) in enumerate(limbs.values(), len(LINKS) + 2):
            poses[f, i, :3], poses[f, i, 3:] = (p + q) / 2, _z_to(direction)
        distance = float(np.linalg.norm(joints[-1] - itch))
        near = distance < 0.035
        press = 4 + 3 * abs(np.sin(f)) if near else 0.0
        if near:
            contacts.append([f, *joints[-1].tolist(), press, 0, _BODY["tool_tip"], _BODY[body]])
        worst, where, touching = _deepest(joints, np.array([(p, q) for p, q, _ in limbs.values()]))
        if worst > 0:
            contacts.append([f, *where.tolist(), 400 * worst, 2, *touching])
        forces.append(400 * worst)
        itch_forces.append(press)
        distances.append(distance)
        counted.append(float(min((counted[-1] if counted else 0) + (near and f % 2), 60)))
    hurt = max(forces) > 4
    helped = counted[-1] >= 25
    return {
        "seed": seed, "dt": DT, "frames": FRAMES, "bodies": MOVING, "poses": encode_poses(poses),
        "itch": {"body": _BODY[body], "pos": out.tolist(), "limb": limb},
        "force_unwanted": forces, "force_itch": itch_forces, "distance": distances,
        "counted": counted, "contacts": contacts,
        "return": 18 - 0.4 * sum(forces) + counted[-1] / 8, "success": helped and not hurt,
        "outcome": "unwanted_contact" if hurt else "helped" if helped else "unhelped",
    }  # fmt: skip


def moments(seed: int, harm: float, count: int) -> dict:
    """Some poses of the arm alone."""
    elbow, wrist, tips, upper, lower = _arm(harm, np.random.default_rng(seed))
    limbs = ((SHOULDER + 0 * elbow, elbow, upper), (elbow, wrist, lower), (wrist, tips, lower))
    frames = np.linspace(0, FRAMES - 1, count).astype(int)
    poses = np.array([
        [[*((p[f] + q[f]) / 2), *_z_to(axis[f])] for p, q, axis in limbs] for f in frames
    ])  # fmt: skip
    return {"frames": count, "bodies": MOVING[-3:], "poses": encode_poses(poses)}


def _rotate(quaternion, vector):
    w, xyz = quaternion[0], quaternion[1:]
    return vector + 2 * np.cross(xyz, np.cross(xyz, vector) + w * vector)

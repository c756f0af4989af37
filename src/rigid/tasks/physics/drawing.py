"""A scene as the report draws it, and how its bodies moved in an episode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.physics.sensing import PersonContacts

_TYPES = {
    mujoco.mjtGeom.mjGEOM_CAPSULE: "capsule",
    mujoco.mjtGeom.mjGEOM_SPHERE: "sphere",
    mujoco.mjtGeom.mjGEOM_BOX: "box",
    mujoco.mjtGeom.mjGEOM_CYLINDER: "cylinder",
    mujoco.mjtGeom.mjGEOM_ELLIPSOID: "ellipsoid",
}


def drawn_scene(
    model: mujoco.MjModel, *, tool: str, furniture: Sequence[str], goal: str
) -> dict[str, Any]:
    """Bodies, shapes and resting poses as the report draws them.

    Args:
        model: The scene; bodies of the robot begin with `jaco`.
        tool: Body that the robot holds; those that begin with its name belong to it.
        furniture: Bodies that are neither robot, tool nor person.
        goal: What the tool is to reach, in a word for readers.
    """
    bodies = [model.body(i).name for i in range(model.nbody)]
    geoms = []
    for index in range(model.ngeom):
        geom = model.geom(index)
        body = int(geom.bodyid[0])
        geoms.append({
            "name": geom.name,
            "body": body,
            "type": _TYPES[mujoco.mjtGeom(int(geom.type[0]))],
            "size": [round(float(x), 5) for x in geom.size],
            "pos": [round(float(x), 5) for x in geom.pos],
            "quat": [round(float(x), 6) for x in geom.quat],
            "rgba": [round(float(x), 3) for x in geom.rgba],
            "role": _role(bodies[body], tool, furniture),
        })  # fmt: skip
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return {
        "bodies": bodies,
        "geoms": geoms,
        "rest": body_poses(data).round(5).tolist(),
        "goal": goal,
    }


def _role(body: str, tool: str, furniture: Sequence[str]) -> str:
    if body in furniture:
        return "chair"
    if body.startswith(tool):
        return "tool"
    return "robot" if body.startswith("jaco") else "human"


def body_poses(data: mujoco.MjData) -> Float[np.ndarray, "bodies 7"]:
    """Position [m] and quaternion w, x, y, z of every body."""
    return np.concatenate([data.xpos, data.xquat], axis=1)


def motion(
    model: mujoco.MjModel, snapshots: Float[np.ndarray, "T1 state"], tool: str, target: str
) -> tuple[Float[np.ndarray, "T1 bodies 7"], Float[np.ndarray, " T1"]]:
    """Pose of every body and the distance [m] of two sites, at each snapshot.

    Args:
        model: The scene.
        snapshots: `World.snapshot`; joint angles come first.
        tool: One site.
        target: The other.
    """
    data = mujoco.MjData(model)
    poses, distances = [], []
    for snapshot in snapshots:
        data.qpos[:] = snapshot[: model.nq]
        mujoco.mj_kinematics(model, data)
        poses.append(body_poses(data))
        distances.append(np.linalg.norm(data.site(tool).xpos - data.site(target).xpos))
    return np.array(poses), np.array(distances)


def chain_poses(
    model: mujoco.MjModel,
    joints: Sequence[str],
    names: Sequence[str],
    features: Float[np.ndarray, "n f"],
) -> dict[str, Any] | None:
    """Bodies of the chain of `joints` and their poses (n, bodies, 7) at given joint angles.

    Args:
        model: The scene.
        joints: Of the chain, the first one first.
        names: Of the features; None is returned unless the joints are among them.
        features: Joint angles [rad], also beyond the joints' limits, and whatever else.
    """
    if not set(joints) <= set(names):
        return None
    columns = [list(names).index(joint) for joint in joints]
    places = [int(model.joint(joint).qposadr[0]) for joint in joints]
    first = model.body_rootid[model.joint(joints[0]).bodyid[0]]
    chain = [i for i in range(model.nbody) if model.body_rootid[i] == first]
    data, poses = mujoco.MjData(model), []
    for angles in features[:, columns]:
        data.qpos[places] = angles
        mujoco.mj_kinematics(model, data)
        poses.append(body_poses(data)[chain])
    return {"bodies": chain, "poses": np.array(poses).reshape(-1, len(chain), 7)}


def anchor(model: mujoco.MjModel, site: str, limb: str, *, below: float = 0.0) -> dict[str, Any]:
    """A place on a body, as `rigid.report.payload.Itch` has it.

    Args:
        model: The scene.
        site: Whose place it is.
        limb: In words for readers.
        below: How far below the site it is, in the body's frame [m].
    """
    place = model.site(site).pos - (0.0, 0.0, below)
    position = [round(float(x), 5) for x in place]
    return {"body": int(model.site(site).bodyid[0]), "pos": position, "limb": limb}


def replayed(
    model: mujoco.MjModel,
    motion: tuple[Float[np.ndarray, "T1 bodies 7"], Float[np.ndarray, " T1"]],
    *,
    control: float,
    itch: Mapping[str, Any],
    contacts: PersonContacts,
    at_target: Float[np.ndarray, "T S"],
) -> dict[str, Any]:
    """What every task shows of an episode, as `rigid.report.payload.Replay` has it.

    Args:
        model: The scene.
        motion: Poses and distances, as `motion` returns them.
        control: Length of a control step [s].
        itch: Where the tool is to go, as `anchor` returns it.
        contacts: Of every control step.
        at_target: The wanted force at every physics step [N].
    """
    poses, distance = motion
    moving = [i for i in range(model.nbody) if model.body_weldid[i] != 0]
    return {
        "dt": round(control, 6),
        "frames": len(poses),
        "bodies": moving,
        "poses": poses[:, moving],
        "itch": itch,
        "force_unwanted": series(contacts.force_unwanted.max(axis=1)),
        "force_itch": series(at_target.max(axis=1)),
        "distance": distance.round(4).tolist(),
    }


def series(per_step: Float[np.ndarray, " T"]) -> list[float]:
    """One value for each frame; nothing has happened at the first."""
    return [0.0, *(round(float(x), 3) for x in per_step)]

"""What the report shows of an episode: poses, and forces simulated again at a millisecond.

Training runs at 0.02 s, where a hit lasts a step or two. For people to look at, every control step
is simulated again from its recorded state with physics steps of at most 0.001 s, all steps side by
side; the recorded motion stays, and contacts are resolved in time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float
from mujoco.batch import Batch

from rigid.tasks.bodies import human, scratcher
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.reward import SUCCESS_CONTACTS
from rigid.tasks.itch_scratching.scene import LIMBS, build_spec
from rigid.tasks.itch_scratching.sensing import Sensors
from rigid.tasks.itch_scratching.touches import contact_marks

FINE_STEP = 0.001
"""Longest physics step of forces that people look at [s] (ours)."""
_TYPES = {
    mujoco.mjtGeom.mjGEOM_CAPSULE: "capsule",
    mujoco.mjtGeom.mjGEOM_SPHERE: "sphere",
    mujoco.mjtGeom.mjGEOM_BOX: "box",
    mujoco.mjtGeom.mjGEOM_CYLINDER: "cylinder",
    mujoco.mjtGeom.mjGEOM_ELLIPSOID: "ellipsoid",
}


def scene(model: mujoco.MjModel) -> dict[str, Any]:
    """Bodies, shapes and resting poses as the report draws them."""
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
            "role": _role(bodies[body]),
        })  # fmt: skip
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    rest = np.concatenate([data.xpos, data.xquat], axis=1).round(5).tolist()
    return {"bodies": bodies, "geoms": geoms, "rest": rest, "keypoints": _keypoints(model)}


def _keypoints(model: mujoco.MjModel) -> list[dict[str, Any]]:
    """Hand, elbow and tool tip (paper, appendix 'More Visualizations of Robot Failure Cases')."""
    hand, tip = model.geom("right_hand"), model.geom(scratcher.TIP_GEOM)
    return [
        {"name": "hand", "body": int(hand.bodyid[0]), "pos": hand.pos.round(5).tolist()},
        # A limb's body frame sits at the joint it hangs from.
        {"name": "elbow", "body": int(model.body("right_forearm").id), "pos": [0.0, 0.0, 0.0]},
        {"name": "tool tip", "body": int(tip.bodyid[0]), "pos": tip.pos.round(5).tolist()},
    ]


def _role(body: str) -> str:
    if body == "wheelchair":
        return "chair"
    if body == "scratcher":
        return "tool"
    return "robot" if body.startswith("jaco") else "human"


def replay(
    parameters: ItchScratchingParameters, snapshots: Float[np.ndarray, "T1 state"]
) -> Mapping[str, Any]:
    """One episode from its snapshots (`World.snapshot` after the reset and after each step)."""
    fine, count = _fine(parameters)
    model = build_spec(fine).compile()
    itch = int(snapshots[0, -2])
    site = model.site(f"itch_{LIMBS[itch]}")
    if parameters.itch_spread:
        site.pos[2] -= snapshots[0, -3]  # Limbs hang along -z of their frame.
    records = _simulate_again(model, snapshots, count)
    contacts = Sensors(model).contacts(records, np.full(len(records), itch))
    poses, distance = _motion(model, snapshots, f"itch_{LIMBS[itch]}")
    moving = [i for i in range(model.nbody) if model.body_weldid[i] != 0]
    counted = snapshots[:, -1].astype(int).tolist()
    return {
        "dt": round(parameters.physics_step * parameters.substeps, 6),
        "frames": len(snapshots),
        "bodies": moving,
        "poses": poses[:, moving],
        "itch": {
            "body": int(site.bodyid[0]),
            "pos": [round(float(x), 5) for x in site.pos],
            "limb": LIMBS[itch].replace("_", " "),
        },
        "force_unwanted": _series(contacts.force_unwanted.max(axis=1)),
        "force_itch": _series(contacts.force_itch.max(axis=1)),
        "distance": distance.round(4).tolist(),
        "counted": counted,
        "contacts": contact_marks(model, snapshots, contacts.touched_unwanted, count),
        "success": counted[-1] >= SUCCESS_CONTACTS,
    }


def human_poses(
    model: mujoco.MjModel, names: Sequence[str], features: Float[np.ndarray, "n f"]
) -> dict[str, Any] | None:
    """Bodies of the right arm and their poses (n, bodies, 7) at given joint angles.

    Args:
        model: The scene.
        names: Of the features; the arm's joints must be among them.
        features: Joint angles [rad], also beyond the joints' limits, and whatever else.
    """
    if not set(human.ARM_JOINTS) <= set(names):
        return None
    columns = [list(names).index(joint) for joint in human.ARM_JOINTS]
    places = [int(model.joint(joint).qposadr[0]) for joint in human.ARM_JOINTS]
    root = model.body("right_shoulder").id
    arm = [i for i in range(model.nbody) if model.body_rootid[i] == root]
    data, poses = mujoco.MjData(model), []
    for angles in features[:, columns]:
        data.qpos[places] = angles
        mujoco.mj_kinematics(model, data)
        poses.append(np.concatenate([data.xpos, data.xquat], axis=1)[arm])
    return {"bodies": arm, "poses": np.array(poses).reshape(-1, len(arm), 7)}


def _motion(
    model: mujoco.MjModel, snapshots: Float[np.ndarray, "T1 state"], itch: str
) -> tuple[Float[np.ndarray, "T1 bodies 7"], Float[np.ndarray, " T1"]]:
    """Pose of every body (position [m], quaternion) and distance of tip and itch [m]."""
    data = mujoco.MjData(model)
    poses, distances = [], []
    for snapshot in snapshots:
        data.qpos[:] = snapshot[: model.nq]
        mujoco.mj_kinematics(model, data)
        poses.append(np.concatenate([data.xpos, data.xquat], axis=1))
        gap = data.site(scratcher.TIP_SITE).xpos - data.site(itch).xpos
        distances.append(np.linalg.norm(gap))
    return np.array(poses), np.array(distances)


def _fine(parameters: ItchScratchingParameters) -> tuple[ItchScratchingParameters, int]:
    """The same scene with steps of at most `FINE_STEP`, and how many fill a control step."""
    control = parameters.physics_step * parameters.substeps
    count = int(np.ceil(control / FINE_STEP))
    return replace(parameters, physics_step=control / count, substeps=count), count


def _simulate_again(
    model: mujoco.MjModel, snapshots: Float[np.ndarray, "T1 state"], count: int
) -> Float[np.ndarray, "T S n"]:
    """Sensors of every fine physics step: one world for each control step of the episode."""
    size = model.nq
    batch = Batch(model, len(snapshots) - 1)
    batch.bind("qpos")[:] = snapshots[:-1, :size]
    batch.bind("qvel")[:] = snapshots[:-1, size : 2 * size]
    batch.bind("ctrl")[:] = snapshots[1:, 2 * size : 3 * size]
    return np.asarray(batch.rollout(count, record=("sensordata",))["sensordata"])


def _series(per_step: Float[np.ndarray, " T"]) -> list[float]:
    """One value for each frame; nothing has happened at the first."""
    return [0.0, *(round(float(x), 3) for x in per_step)]

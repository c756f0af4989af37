"""What the report shows of an episode: poses, and forces simulated again at a millisecond."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bed_bathing.parameters import BedBathingParameters
from rigid.tasks.bed_bathing.points import LIMBS, arm_points
from rigid.tasks.bed_bathing.scene import ARM, add_points, build_spec, points_body
from rigid.tasks.bed_bathing.sensing import Sensors
from rigid.tasks.bodies import bed, lying, wiper
from rigid.tasks.physics.again import simulate_again
from rigid.tasks.physics.drawing import body_poses, drawn_scene, replayed
from rigid.tasks.physics.parameters import finely
from rigid.tasks.physics.touches import AT_TARGET, UNWANTED, Touch, TouchFinder

_GOAL = "right arm"  # Not "arm": reports speak of the robot's as well.


def drawn_model(parameters: BedBathingParameters) -> mujoco.MjModel:
    """The scene with the points to wipe, which physics knows nothing of."""
    spec = build_spec(parameters)
    add_points(spec, parameters)
    return spec.compile()


def scene(parameters: BedBathingParameters) -> dict[str, Any]:
    """Bodies, shapes and resting poses as the report draws them."""
    model = drawn_model(parameters)
    # Points are drawn as furniture is: neither skin nor, as tools are, dark.
    furniture = (bed.BED_BODY, bed.CABINET_BODY, *(points_body(limb) for limb in LIMBS))
    drawn = drawn_scene(model, tool=wiper.WIPER_BODY, furniture=furniture, goal=_GOAL)
    return {**drawn, "keypoints": _keypoints(model)}


def _keypoints(model: mujoco.MjModel) -> list[dict[str, Any]]:
    hand, pad = model.geom("right_hand"), model.geom(wiper.PAD_GEOM)
    return [
        {"name": "hand", "body": int(hand.bodyid[0]), "pos": hand.pos.round(5).tolist()},
        # A limb's body frame sits at the joint it hangs from.
        {"name": "elbow", "body": int(model.body("right_forearm").id), "pos": [0.0, 0.0, 0.0]},
        {"name": "pad", "body": int(pad.bodyid[0]), "pos": pad.pos.round(5).tolist()},
    ]


def replay(
    parameters: BedBathingParameters, snapshots: Float[np.ndarray, "T1 state"]
) -> Mapping[str, Any]:
    """One episode from its snapshots (`World.snapshot` after the reset and after each step)."""
    fine, points = finely(parameters), arm_points(parameters.body_size)
    model, count = drawn_model(fine), fine.substeps
    contacts = Sensors(model).contacts(simulate_again(model, snapshots, count))
    wiped = snapshots[:, -len(points.limb) :].sum(axis=1).astype(int).tolist()
    shown = replayed(
        model,
        _motion(model, snapshots),
        control=parameters.control_period,
        itch=arm_of(model),
        contacts=contacts,
        at_target=contacts.force_pad,
    )
    return {
        **shown,
        "wiped": wiped,
        "contacts": _marks(model, snapshots, contacts.touched_unwanted, count),
        "success": wiped[-1] >= points.enough,
    }


def arm_of(model: mujoco.MjModel) -> dict[str, Any]:
    """Where the robot shall wipe, as the place of an itch: the arm has its middle at the elbow."""
    elbow = int(model.body("right_forearm").id)
    return {"body": elbow, "pos": [0.0, 0.0, 0.0], "limb": _GOAL}


def _motion(
    model: mujoco.MjModel, snapshots: Float[np.ndarray, "T1 state"]
) -> tuple[Float[np.ndarray, "T1 bodies 7"], Float[np.ndarray, " T1"]]:
    """Pose of every body and the distance [m] of pad and arm, at each snapshot."""
    data, pad = mujoco.MjData(model), int(model.geom(wiper.PAD_GEOM).id)
    limbs = [int(model.geom(f"right_{limb}").id) for limb in LIMBS]
    poses, distances, far = [], [], 10.0
    for snapshot in snapshots:
        data.qpos[:] = snapshot[: model.nq]
        mujoco.mj_kinematics(model, data)
        poses.append(body_poses(data))
        gaps = [mujoco.mj_geomDistance(model, data, pad, limb, far, None) for limb in limbs]
        distances.append(max(min(gaps), 0.0))
    return np.array(poses), np.array(distances)


def _marks(
    model: mujoco.MjModel, snapshots: np.ndarray, unwanted: np.ndarray, count: int
) -> list[list[float]]:
    """Contacts of robot and person; wanted ones are those of pad and right arm."""
    pad = int(model.body(wiper.PAD_BODY).id)
    arm = frozenset(int(model.body(part).id) for part in ARM)

    def kind(_: mujoco.MjData, touch: Touch) -> int:
        return AT_TARGET if touch.robot == pad and touch.person in arm else UNWANTED

    return TouchFinder(model, lying.PARTS, kind).marks(snapshots, unwanted, count)

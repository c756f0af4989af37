"""What the report shows of an episode: poses, and forces simulated again at a millisecond."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import human, scratcher
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.reward import SUCCESS_CONTACTS
from rigid.tasks.itch_scratching.scene import LIMBS, build_spec
from rigid.tasks.itch_scratching.sensing import Sensors
from rigid.tasks.itch_scratching.touches import contact_marks
from rigid.tasks.physics.again import fine_steps, simulate_again
from rigid.tasks.physics.drawing import chain_poses, drawn_scene, motion, series


def scene(model: mujoco.MjModel) -> dict[str, Any]:
    """Bodies, shapes and resting poses as the report draws them."""
    drawn = drawn_scene(model, tool="scratcher", furniture=("wheelchair",))
    return {**drawn, "keypoints": _keypoints(model)}


def _keypoints(model: mujoco.MjModel) -> list[dict[str, Any]]:
    """Hand, elbow and tool tip (paper, appendix 'More Visualizations of Robot Failure Cases')."""
    hand, tip = model.geom("right_hand"), model.geom(scratcher.TIP_GEOM)
    return [
        {"name": "hand", "body": int(hand.bodyid[0]), "pos": hand.pos.round(5).tolist()},
        # A limb's body frame sits at the joint it hangs from.
        {"name": "elbow", "body": int(model.body("right_forearm").id), "pos": [0.0, 0.0, 0.0]},
        {"name": "tool tip", "body": int(tip.bodyid[0]), "pos": tip.pos.round(5).tolist()},
    ]


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
    records = simulate_again(model, snapshots, count)
    contacts = Sensors(model).contacts(records, np.full(len(records), itch))
    poses, distance = motion(model, snapshots, scratcher.TIP_SITE, f"itch_{LIMBS[itch]}")
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
        "force_unwanted": series(contacts.force_unwanted.max(axis=1)),
        "force_itch": series(contacts.force_itch.max(axis=1)),
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
    return chain_poses(model, human.ARM_JOINTS, "right_shoulder", names, features)


def _fine(parameters: ItchScratchingParameters) -> tuple[ItchScratchingParameters, int]:
    """The same scene with fine physics steps, and how many of them fill a control step."""
    step, count = fine_steps(parameters.physics_step * parameters.substeps)
    return replace(parameters, physics_step=step, substeps=count), count

"""What the report shows of an episode: poses, and forces simulated again at a millisecond."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import scratcher
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.reward import SUCCESS_CONTACTS
from rigid.tasks.itch_scratching.scene import LIMBS, build_spec
from rigid.tasks.itch_scratching.sensing import Sensors
from rigid.tasks.itch_scratching.touches import contact_marks
from rigid.tasks.physics.again import simulate_again
from rigid.tasks.physics.drawing import anchor, drawn_scene, motion, replayed
from rigid.tasks.physics.parameters import finely


def scene(model: mujoco.MjModel) -> dict[str, Any]:
    """Bodies, shapes and resting poses as the report draws them."""
    drawn = drawn_scene(model, tool="scratcher", furniture=("wheelchair",), goal="itch")
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
    fine = finely(parameters)
    model, count = build_spec(fine).compile(), fine.substeps
    itch, spread = int(snapshots[0, -2]), parameters.itch_spread > 0
    target, shown = f"itch_{LIMBS[itch]}", itch_of(model, snapshots[0], spread=spread)
    if spread:
        model.site(target).pos[2] -= snapshots[0, -3]
    records = simulate_again(model, snapshots, count)
    contacts = Sensors(model).contacts(records, np.full(len(records), itch))
    counted = snapshots[:, -1].astype(int).tolist()
    return {
        **replayed(
            model,
            motion(model, snapshots, scratcher.TIP_SITE, target),
            control=parameters.control_period,
            itch=shown,
            contacts=contacts,
            at_target=contacts.force_itch,
        ),
        "counted": counted,
        "contacts": contact_marks(model, snapshots, contacts.touched_unwanted, count),
        "success": counted[-1] >= SUCCESS_CONTACTS,
    }


def itch_of(
    model: mujoco.MjModel, snapshot: Float[np.ndarray, " state"], *, spread: bool
) -> dict[str, Any]:
    """Where it itches: body, place in its frame [m], and the limb in plain words.

    Args:
        model: The scene.
        snapshot: Any of the episode (`World.snapshot`).
        spread: Whether itches are spread along the limbs.
    """
    limb = LIMBS[int(snapshot[-2])]
    below = float(snapshot[-3]) if spread else 0.0  # Limbs hang along -z of their frame.
    return anchor(model, f"itch_{limb}", limb.replace("_", " "), below=below)

"""What the report shows of an episode: poses, food, and forces simulated again at a millisecond."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import head, spoon
from rigid.tasks.feeding.food import ENOUGH, GRAVITY, PIECES, RADIUS, Piece
from rigid.tasks.feeding.parameters import FeedingParameters
from rigid.tasks.feeding.scene import PARTS, Below, add_food, build_spec, food_body
from rigid.tasks.feeding.sensing import LIPS, Sensors
from rigid.tasks.physics.again import simulate_again
from rigid.tasks.physics.drawing import anchor, drawn_scene, motion, replayed
from rigid.tasks.physics.parameters import finely
from rigid.tasks.physics.touches import AT_TARGET, UNWANTED, Touch, TouchFinder


def drawn_model(parameters: FeedingParameters) -> mujoco.MjModel:
    """The scene with the food, which physics knows nothing of."""
    spec = build_spec(parameters)
    add_food(spec)
    return spec.compile()


def scene(parameters: FeedingParameters) -> dict[str, Any]:
    """Bodies, shapes and resting poses as the report draws them."""
    model = drawn_model(parameters)
    # Food is drawn as furniture is, since tools are dark.
    pale = ("wheelchair", "table", *(food_body(index) for index in range(len(PIECES))))
    drawn = drawn_scene(model, tool="spoon", furniture=pale, goal="mouth")
    bowl, (y, z) = model.geom(spoon.BOWL_GEOM), parameters.body_size.mouth
    keypoints = [
        {"name": "mouth", "body": int(model.body(head.HEAD_BODY).id), "pos": [0.0, y, z]},
        {"name": "spoon", "body": int(bowl.bodyid[0]), "pos": bowl.pos.round(5).tolist()},
    ]
    return {**drawn, "keypoints": keypoints}


def replay(
    parameters: FeedingParameters, snapshots: Float[np.ndarray, "T1 state"], below: Below
) -> Mapping[str, Any]:
    """One episode from its snapshots (`World.snapshot` after the reset and after each step)."""
    fine, control = finely(parameters), parameters.control_period
    model, count = drawn_model(fine), fine.substeps
    contacts = Sensors(model).contacts(simulate_again(model, snapshots, count))
    poses, distance = motion(model, snapshots, spoon.SPOON_SITE, head.MOUTH_SITE)
    states = snapshots[:, -len(PIECES) :].astype(int)
    _place_food(model, poses, states, below, control)
    eaten = (states == Piece.EATEN).sum(axis=1)
    shown = replayed(
        model,
        (poses, distance),
        control=control,
        itch=mouth_of(model),
        contacts=contacts,
        at_target=contacts.force_mouth,
    )
    return {
        **shown,
        "eaten": eaten.tolist(),
        "spilled": (states == Piece.SPILLED).sum(axis=1).tolist(),
        "contacts": _marks(model, snapshots, contacts.touched_unwanted, count),
        "success": int(eaten[-1]) >= ENOUGH,
    }


def mouth_of(model: mujoco.MjModel) -> dict[str, Any]:
    """Where food shall go, as the place of an itch: body, place in its frame [m], and its name."""
    return anchor(model, head.MOUTH_SITE, "mouth")


def _marks(
    model: mujoco.MjModel, snapshots: np.ndarray, unwanted: np.ndarray, count: int
) -> list[list[float]]:
    """Contacts of robot and person; wanted ones are those of spoon and mouth."""
    held, face = (int(model.body(name).id) for name in (spoon.SPOON_BODY, head.HEAD_BODY))

    def kind(data: mujoco.MjData, touch: Touch) -> int:
        gap = np.linalg.norm(np.array(touch.place) - data.site(head.MOUTH_SITE).xpos)
        fed = (touch.robot, touch.person) == (held, face) and gap < LIPS
        return AT_TARGET if fed else UNWANTED

    return TouchFinder(model, PARTS, kind).marks(snapshots, unwanted, count)


def _place_food(
    model: mujoco.MjModel,
    poses: Float[np.ndarray, "T1 bodies 7"],
    states: np.ndarray,
    below: Below,
    control: float,
) -> None:
    """Moves food that is no longer on the spoon: eaten into the head, spilled straight down."""
    face = int(model.body(head.HEAD_BODY).id)
    for index, state in enumerate(states.T):
        body = int(model.body(food_body(index)).id)
        gone = np.flatnonzero(state != Piece.HELD)
        if not len(gone):
            continue
        first = int(gone[0])
        if state[first] == Piece.EATEN:
            poses[first:, body] = poses[first:, face]
            continue
        start = poses[max(first - 1, 0), body].copy()
        ground = float(below(start[None, :3])[0][0]) + RADIUS
        fallen = GRAVITY / 2 * (control * np.arange(1, len(poses) - first + 1)) ** 2
        poses[first:, body] = start
        poses[first:, body, 2] = np.maximum(start[2] - fallen, min(ground, start[2]))

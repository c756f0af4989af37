"""What a contact of robot and person means while it itches somewhere."""

from __future__ import annotations

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from rigid.tasks.bodies import human
from rigid.tasks.itch_scratching.scene import LIMBS
from rigid.tasks.physics.touches import ALLOWED, AT_TARGET, UNWANTED, Touch, TouchFinder


def contact_marks(
    model: mujoco.MjModel,
    snapshots: Float[np.ndarray, "T1 state"],
    unwanted: Bool[np.ndarray, " T"],
    count: int,
) -> list[list[float]]:
    """Where robot and person touch at the end of each step, and hits that are over by then.

    Args:
        model: The scene with the fine physics step of the replay.
        snapshots: `World.snapshot` after the reset and after each step.
        unwanted: Steps with force outside the arms at some physics step. Where the end of such a
            step shows no unwanted contact, the hardest one within it is marked.
        count: Physics steps of a control step.

    Returns:
        Rows of frame, place x, y, z [m], normal force [N], kind (0 on the itching limb, 1 elsewhere
        on the arms, 2 unwanted), and the bodies of robot and person, indices into the scene's.
    """
    trunk = frozenset(int(model.body(name).id) for name in human.TRUNK_PARTS)
    limb = int(model.body(f"right_{LIMBS[int(snapshots[0, -2])]}").id)

    def kind(_: mujoco.MjData, touch: Touch) -> int:
        on_arms = AT_TARGET if touch.person == limb else ALLOWED
        return UNWANTED if touch.person in trunk else on_arms

    person = human.TRUNK_PARTS + human.ARM_PARTS
    return TouchFinder(model, person, kind).marks(snapshots, unwanted, count)

"""The moment of an episode that people see as a still.

Ours: the paper shows 'single-timestep snapshots' (appendix 'Questionnaire GUI Interface') and does
not say how their time steps were chosen. Every member of every pair goes through the same rule.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, Literal, NamedTuple

import numpy as np
from jaxtyping import Float

from rigid.errors import UserError
from rigid.frontier.pairs import Kind
from rigid.tasks.protocol import Task

DEVIATION = (
    "the step at which the human is farthest from the reference: mean distance of the parts of "
    "its body that move to where they are at the nearest moment of the reference, whenever that is"
)
FORCE = f"the step of the greatest unwanted force on the person, and without any {DEVIATION}"


class Moment(NamedTuple):
    """A step of an episode, 0 after the reset, and what chose it."""

    step: int
    by: Literal["force", "deviation"]


def rule_text(kind: Kind) -> str:
    """How the moments of a kind of pairs are chosen, in words."""
    return FORCE if kind == "danger" else DEVIATION


def people_in(task: Task) -> frozenset[int]:
    """Bodies of the task's scene that are the person's.

    Raises:
        UserError: The task draws nothing, so that there is nothing to show.
    """
    scene = task.scene()
    if scene is None:
        raise UserError(
            f"task {task.name!r} draws nothing of an episode, so there is nothing to show people: "
            "pick pairs from runs of a task with a scene"
        )
    return frozenset(int(geom["body"]) for geom in scene["geoms"] if geom["role"] == "human")


def moment(
    shown: Mapping[str, Any], reference: Mapping[str, Any], people: Collection[int], kind: Kind
) -> Moment:
    """The moment of one episode, after the rule of the kind of its pair; the earliest of equals.

    At its greatest deviation all that an observer could hold against an episode is in the picture,
    so that a human who is not natural has the least chance to pass. Of two dangerous moments that
    of the greatest force is the one that people are asked about.

    Args:
        shown: `Task.replay` of the episode.
        reference: That of the canonical episode beside it.
        people: The person's bodies.
        kind: Of the pair.
    """
    force = np.asarray(shown.get("force_unwanted", ()), dtype=float)
    if kind == "danger" and force.size and force.max() > 0:
        return Moment(int(force.argmax()), "force")
    apart = deviation(_places(shown, people), _places(reference, people))
    return Moment(int(apart.argmax()), "deviation")


def deviation(
    shown: Float[np.ndarray, "T b 3"], reference: Float[np.ndarray, "S b 3"]
) -> Float[np.ndarray, " T"]:
    """Distance of each frame to the nearest one of the reference, mean over bodies [m].

    The nearest, not the simultaneous one: who looks at a still and a moving reference searches that
    for the pose. People are not unnatural for being slower.

    Example:
        >>> move = np.array([[[0.0, 0, 0]], [[1.0, 0, 0]]])
        >>> deviation(move[::-1] + [0, 0.5, 0], move)
        array([0.5, 0.5])
    """
    apart = np.linalg.norm(shown[:, None] - reference[None], axis=-1).mean(axis=-1)
    return np.asarray(apart.min(axis=1))


def _places(replay: Mapping[str, Any], people: Collection[int]) -> Float[np.ndarray, "T b 3"]:
    """Where the person's moving bodies are."""
    columns = [place for place, body in enumerate(replay["bodies"]) if body in people]
    return np.asarray(replay["poses"], dtype=float)[:, columns, :3]

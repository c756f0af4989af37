"""What a task offers beyond `rigid.tasks.protocol` so that a person can play its human by hand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float


class Reach(NamedTuple):
    """The ball in which targets for the point that a player moves make sense."""

    centre: Float[np.ndarray, "3"]
    """World frame [m]; of an arm its shoulder at rest."""
    radius: float
    """As far as the point gets from there with everything stretched out [m]."""


@runtime_checkable
class Handle(Protocol):
    """One point of the human's body by which a player moves the human, for one episode.

    States are rows of `World.snapshot`, so that what a player did can be told from a recording.
    """

    bodies: tuple[int, ...]
    """The bodies that move: indices into those of `Task.scene()`."""
    substeps: int
    """Physics steps of a control step."""
    reach: Reach

    def place(self, state: Float[np.ndarray, " state"]) -> Float[np.ndarray, "3"]:
        """Where the point is [m], world frame."""
        ...

    def towards(
        self, state: Float[np.ndarray, " state"], target: Float[np.ndarray, "3"]
    ) -> Float[np.ndarray, " a"]:
        """The human's action in [-1, 1] that moves the point towards `target` [m]."""
        ...

    def goal(self, state: Float[np.ndarray, " state"]) -> Mapping[str, Any] | None:
        """What to show the player of the aim, as replays have `itch`: body, pos and limb."""
        ...

    def counted(self, state: Float[np.ndarray, " state"]) -> int:
        """How much of the aim is reached so far, in what the task counts."""
        ...

    def poses(
        self, motion: Float[np.ndarray, "S nq"], state: Float[np.ndarray, " state"]
    ) -> Float[np.ndarray, "S bodies 7"]:
        """Position [m] and quaternion w, x, y, z of `bodies`; call once a control step, in order.

        Args:
            motion: Joint angles [rad] after each physics step (`KeepsMotion.motion`).
            state: After the control step.
        """
        ...


@runtime_checkable
class PlayedByHand(Protocol):
    """A task whose human can be played by moving one point of the body; optional.

    Its worlds are `KeepsMotion`, and their steps tell `force_unwanted` [N] in `info`.
    """

    def make_handle(self) -> Handle:
        """A handle for one episode."""
        ...

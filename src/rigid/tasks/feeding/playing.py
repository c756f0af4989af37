"""The mouth as what a player holds, and the food on its way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import mujoco
import numpy as np
from jaxtyping import Float, Int

from rigid.tasks.bodies import head
from rigid.tasks.feeding.food import GRAVITY, PIECES, RADIUS, Piece
from rigid.tasks.feeding.parameters import FeedingParameters
from rigid.tasks.feeding.replay import drawn_model, mouth_of
from rigid.tasks.feeding.scene import Below, food_body
from rigid.tasks.physics.handle import MovedPoint
from rigid.tasks.physics.reaching import PulledChain

_UPRIGHT = np.zeros(len(head.HEAD_JOINTS))


class Mouth(MovedPoint):
    """See `rigid.tasks.by_hand.Handle`: the mouth, moved by the 4 joints of neck and head."""

    def __init__(self, parameters: FeedingParameters, below: Below) -> None:
        """Takes hold of the mouth in the scene of a task with these parameters.

        Args:
            parameters: Of the task.
            below: Where falling food lands.
        """
        model = drawn_model(parameters)
        chain = PulledChain(
            model,
            head.HEAD_JOINTS,
            body=head.HEAD_BODY,
            point=np.array(model.site(head.MOUTH_SITE).pos),
            period=parameters.control_period,
        )
        super().__init__(
            model,
            chain,
            root="neck",
            rest=_UPRIGHT,
            natural=lambda _: _UPRIGHT,
            substeps=parameters.substeps,
        )
        self._face = self.bodies.index(model.body(head.HEAD_BODY).id)
        self._food = _FallingFood(model, self.bodies, below, parameters.physics_step)

    def goal(self, state: Float[np.ndarray, " state"]) -> Mapping[str, Any]:
        """The mouth, to which the food shall come."""
        del state
        return mouth_of(self.model)

    def counted(self, state: Float[np.ndarray, " state"]) -> int:
        """Pieces eaten so far."""
        return int((_pieces(state) == Piece.EATEN).sum())

    def poses(
        self, motion: Float[np.ndarray, "S nq"], state: Float[np.ndarray, " state"]
    ) -> Float[np.ndarray, "S bodies 7"]:
        """As that of any moved point, with food that was eaten or spilled where it is now."""
        poses = super().poses(motion, state)
        self._food.place(poses, _pieces(state), self._face)
        return poses


def _pieces(state: Float[np.ndarray, " state"]) -> Int[np.ndarray, "8"]:
    return np.asarray(state[-len(PIECES) :]).astype(np.int64)


class _Fall(NamedTuple):
    """A piece that has left the spoon."""

    start: Float[np.ndarray, "7"]
    """Its pose as it left."""
    ground: float
    """How low it gets [m]."""


class _FallingFood:
    """Where food is that has left the spoon; remembers where and how long ago each piece did."""

    def __init__(
        self, model: mujoco.MjModel, bodies: tuple[int, ...], below: Below, physics_step: float
    ) -> None:
        names = (food_body(index) for index in range(len(PIECES)))
        self._columns = [bodies.index(model.body(name).id) for name in names]
        self._below, self._step = below, physics_step
        self._falls: dict[int, _Fall] = {}
        self._steps = np.zeros(len(PIECES), dtype=np.int64)
        self._before = np.zeros((len(PIECES), 7))

    def place(
        self, poses: Float[np.ndarray, "S bodies 7"], pieces: Int[np.ndarray, "8"], face: int
    ) -> None:
        """Moves what has left the spoon: what was eaten into the head, the rest straight down."""
        for index in np.flatnonzero(pieces != Piece.HELD).tolist():
            column = self._columns[index]
            if pieces[index] == Piece.EATEN:
                poses[:, column] = poses[:, face]
            else:
                self._drop(poses[:, column], index)
        self._before = poses[-1, self._columns]

    def _drop(self, poses: Float[np.ndarray, "S 7"], index: int) -> None:
        if index not in self._falls:
            self._falls[index] = self._fall_from(self._before[index])
        start, ground = self._falls[index]
        times = self._step * (self._steps[index] + np.arange(1, len(poses) + 1))
        self._steps[index] += len(poses)
        poses[:] = start
        poses[:, 2] = np.maximum(start[2] - GRAVITY / 2 * times**2, ground)

    def _fall_from(self, start: Float[np.ndarray, "7"]) -> _Fall:
        ground = float(self._below(start[None, :3])[0][0]) + RADIUS
        return _Fall(start, min(ground, float(start[2])))

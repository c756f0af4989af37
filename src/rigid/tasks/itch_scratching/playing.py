"""The right hand as what a player holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import human
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.posture import arm_of, stored_posture
from rigid.tasks.itch_scratching.replay import itch_of
from rigid.tasks.physics.handle import MovedPoint


class RightHand(MovedPoint):
    """See `rigid.tasks.by_hand.Handle`: the middle of the hand, moved by the arm's 10 joints."""

    def __init__(self, model: mujoco.MjModel, parameters: ItchScratchingParameters) -> None:
        """Takes hold of the hand in the scene of a task with these parameters."""
        arm, seated = arm_of(model, parameters), human.start_angles()
        posture, home = stored_posture(), arm.place(seated)
        super().__init__(
            model,
            arm,
            root="right_upper_arm",
            rest=seated,
            natural=lambda place: posture.at(place - home),
            substeps=parameters.substeps,
        )
        self._spread = parameters.itch_spread > 0

    def goal(self, state: Float[np.ndarray, " state"]) -> Mapping[str, Any]:
        """Where it itches."""
        return itch_of(self.model, state, spread=self._spread)

    def counted(self, state: Float[np.ndarray, " state"]) -> int:
        """Counted contacts so far."""
        return int(state[-1])

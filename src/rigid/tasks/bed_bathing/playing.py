"""The right hand as what a player holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.tasks.bed_bathing.parameters import BedBathingParameters
from rigid.tasks.bed_bathing.points import arm_points
from rigid.tasks.bed_bathing.replay import arm_of, drawn_model
from rigid.tasks.bodies import human, lying
from rigid.tasks.physics.handle import MovedPoint
from rigid.tasks.physics.reaching import PulledChain


class RightHand(MovedPoint):
    """See `rigid.tasks.by_hand.Handle`: the middle of the hand, moved by the arm's 10 joints."""

    def __init__(self, parameters: BedBathingParameters) -> None:
        """Takes hold of the hand in the scene of a task with these parameters."""
        model, size = drawn_model(parameters), parameters.body_size
        arm = PulledChain(
            model,
            human.ARM_JOINTS,
            body="right_hand",
            point=np.array(model.geom("right_hand").pos),
            period=parameters.control_period,
        )
        rest = lying.start_angles(size)
        super().__init__(
            model,
            arm,
            root="right_upper_arm",
            rest=rest,
            natural=lambda _: rest,
            substeps=parameters.substeps,
        )
        self._points = len(arm_points(size).limb)

    def goal(self, state: Float[np.ndarray, " state"]) -> Mapping[str, Any]:
        """The arm, which the robot shall wipe."""
        del state
        return arm_of(self.model)

    def counted(self, state: Float[np.ndarray, " state"]) -> int:
        """Points wiped so far."""
        return int(state[-self._points :].sum())

"""Bed bathing as a task: sizes, bounds, outcomes and worlds (`rigid/BedBathing-v0`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bed_bathing import observation
from rigid.tasks.bed_bathing.parameters import BedBathingParameters
from rigid.tasks.bed_bathing.points import ArmPoints, arm_points
from rigid.tasks.bed_bathing.scene import build_spec
from rigid.tasks.bed_bathing.starts import STARTS
from rigid.tasks.bed_bathing.world import BedBathingWorld
from rigid.tasks.bodies import human, lying
from rigid.tasks.by_hand import Handle
from rigid.tasks.physics.task import DrivenTask, joint_features, joint_units

RETURN_RANGE = (-40.0, 370.0)
"""Returns that map to adversarialness 1 and 0, frozen for version 0: the rounded mean returns of
λ = 0 at the paper's budget against the bundled vanilla robot (-36.1, two seeds) and of canonical
play with it (372.2)."""


class BedBathing(DrivenTask[BedBathingParameters]):
    """A robot arm wipes the right arm of a person who lies on a bed and moves that arm.

    Both agents share the reward, and neither sees which points are left. An episode is helped when
    30 % of the points on upper arm and forearm are wiped in 100 steps at 10 Hz.
    """

    name = "bed-bathing"
    moving = human.ARM_JOINTS
    poses_at_start = STARTS
    feature_names = joint_features(human.ARM_JOINTS)
    feature_units: Mapping[str, str] = joint_units(human.ARM_JOINTS)
    shown_human = observation.ARM_NAMES
    return_range: tuple[float, float] | None = RETURN_RANGE

    def __init__(self, parameters: BedBathingParameters | None = None) -> None:
        """Builds the task.

        Args:
            parameters: Body, impairment, physics; the reference person by default.
        """
        super().__init__(
            parameters or BedBathingParameters(),
            robot_sees=observation.ROBOT_NAMES,
            human_sees=observation.HUMAN_NAMES,
        )
        self.chest = lying.chest_origin(self.parameters.body_size)

    def build_spec(self) -> mujoco.MjSpec:
        """Bed, person, arm and wiper, with their sensors."""
        return build_spec(self.parameters)

    @cached_property
    def points(self) -> ArmPoints:
        """The points that are to be wiped."""
        return arm_points(self.parameters.body_size)

    def make_world(self, batch: int, *, threads: int = 0) -> BedBathingWorld:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""
        return BedBathingWorld(self, batch, threads)

    def with_parameters(self, **changes: Any) -> BedBathing:
        """The task with some parameters changed."""
        return BedBathing(replace(self.parameters, **changes))

    def scene(self) -> Mapping[str, Any]:
        """Bodies and shapes as the report draws them."""
        from rigid.tasks.bed_bathing import replay

        return replay.scene(self.parameters)

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Poses, forces and contacts of one episode as the report shows them."""
        from rigid.tasks.bed_bathing import replay

        return replay.replay(self.parameters, snapshots)

    def make_handle(self) -> Handle:
        """The right hand, by which a player moves the arm."""
        from rigid.tasks.bed_bathing.playing import RightHand

        return RightHand(self.parameters)

"""Feeding as a task: sizes, bounds, outcomes and worlds (`rigid/Feeding-v0`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import head
from rigid.tasks.by_hand import Handle
from rigid.tasks.feeding import observation
from rigid.tasks.feeding.parameters import FeedingParameters
from rigid.tasks.feeding.scene import Below, build_spec
from rigid.tasks.feeding.starts import STARTS
from rigid.tasks.feeding.world import FeedingWorld
from rigid.tasks.physics.task import DrivenTask, joint_features, joint_units

RETURN_RANGE = (-20.0, 150.0)
"""Returns that map to adversarialness 1 and 0, frozen for version 0: the rounded mean returns of
λ = 0 at the paper's budget against the bundled vanilla robot (-15.9, two seeds) and of canonical
play with it (147.8)."""


class Feeding(DrivenTask[FeedingParameters]):
    """A robot arm brings a spoon of food to the mouth of a person who moves the head.

    Both agents share the reward, and both see the mouth. An episode is helped when 6 of 8 pieces of
    food reach the mouth in 100 steps at 10 Hz.
    """

    name = "feeding"
    moving = head.HEAD_JOINTS
    poses_at_start = STARTS
    feature_names = joint_features(head.HEAD_JOINTS)
    feature_units: Mapping[str, str] = joint_units(head.HEAD_JOINTS)
    return_range: tuple[float, float] | None = RETURN_RANGE

    def __init__(self, parameters: FeedingParameters | None = None) -> None:
        """Builds the task.

        Args:
            parameters: Body, impairment, physics; the reference person by default.
        """
        super().__init__(
            parameters or FeedingParameters(),
            robot_sees=observation.ROBOT_NAMES,
            human_sees=observation.HUMAN_NAMES,
        )

    def build_spec(self) -> mujoco.MjSpec:
        """Wheelchair, table, person, arm and spoon, with their sensors."""
        return build_spec(self.parameters)

    @cached_property
    def below(self) -> Below:
        """Where falling food lands."""
        return Below(self.parameters)

    def make_world(self, batch: int, *, threads: int = 0) -> FeedingWorld:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""
        return FeedingWorld(self, batch, threads)

    def with_parameters(self, **changes: Any) -> Feeding:
        """The task with some parameters changed."""
        return Feeding(replace(self.parameters, **changes))

    def scene(self) -> Mapping[str, Any]:
        """Bodies and shapes as the report draws them."""
        from rigid.tasks.feeding import replay

        return replay.scene(self.parameters)

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Poses, forces and contacts of one episode as the report shows them."""
        from rigid.tasks.feeding import replay

        return replay.replay(self.parameters, snapshots, self.below)

    def make_handle(self) -> Handle:
        """The mouth, by which a player moves the head."""
        from rigid.tasks.feeding.playing import Mouth

        return Mouth(self.parameters, self.below)

"""Itch scratching as a task: sizes, bounds, outcomes and worlds (`rigid/ItchScratching-v0`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import human
from rigid.tasks.by_hand import Handle
from rigid.tasks.itch_scratching import observation
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.scene import LIMBS, build_spec
from rigid.tasks.itch_scratching.starts import STARTS
from rigid.tasks.itch_scratching.world import ItchScratchingWorld
from rigid.tasks.physics.task import DrivenTask, joint_features, joint_units

RETURN_RANGE = (-270.0, 450.0)
"""Returns that map to adversarialness 1 and 0, frozen for version 0: the rounded mean returns of
λ = 0 (`rigid frontier --preset paper --lambdas 0`: -91, -356 and -368) and of canonical play (454),
both with `builtin:vanilla`."""


class ItchScratching(DrivenTask[ItchScratchingParameters]):
    """A robot arm scratches the itch of a seated person; only the person knows where it itches.

    Both agents share the reward. One of two fixed points itches, drawn per episode (any point of
    either limb at `itch_spread` 1). An episode is helped when the scratcher makes 25 counted
    contacts in 100 steps at 10 Hz.
    """

    name = "itch-scratching"
    moving = human.ARM_JOINTS
    poses_at_start = STARTS
    feature_names = (
        *joint_features(human.ARM_JOINTS),
        *(f"itch_{limb}" for limb in LIMBS),
    )
    feature_units: Mapping[str, str] = joint_units(human.ARM_JOINTS)
    shown_human = observation.ARM_NAMES
    return_range: tuple[float, float] | None = RETURN_RANGE

    def __init__(
        self, parameters: ItchScratchingParameters | None = None, *, itch_visible: bool = False
    ) -> None:
        """Builds the task.

        Args:
            parameters: Body, impairment, itch, physics; the reference person by default.
            itch_visible: Whether the robot sees the itch. Only for co-optimisation: a robot
                measured by RIGID never does.
        """
        self.itch_visible = itch_visible
        seen = observation.ROBOT_SEEING_NAMES if itch_visible else observation.ROBOT_NAMES
        super().__init__(
            parameters or ItchScratchingParameters(),
            robot_sees=seen,
            human_sees=observation.HUMAN_NAMES,
        )

    def build_spec(self) -> mujoco.MjSpec:
        """Wheelchair, person, arm and scratcher, with their sensors."""
        return build_spec(self.parameters)

    def seeing_the_itch(self) -> ItchScratching:
        """The same task with the itch in the robot's observation, for co-optimisation."""
        return ItchScratching(self.parameters, itch_visible=True)

    def diversified(self) -> ItchScratching:
        """The same task with the itch anywhere along both limbs."""
        return self.with_parameters(itch_spread=1.0)

    def make_world(self, batch: int, *, threads: int = 0) -> ItchScratchingWorld:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""
        return ItchScratchingWorld(self, batch, threads)

    def with_parameters(self, **changes: Any) -> ItchScratching:
        """The task with some parameters changed."""
        return ItchScratching(replace(self.parameters, **changes), itch_visible=self.itch_visible)

    def scene(self) -> Mapping[str, Any]:
        """Bodies and shapes as the report draws them."""
        from rigid.tasks.itch_scratching import replay

        return replay.scene(self.model)

    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Poses, forces and contacts of one episode as the report shows them."""
        from rigid.tasks.itch_scratching import replay

        return replay.replay(self.parameters, snapshots)

    def make_handle(self) -> Handle:
        """The right hand, by which a player moves the arm."""
        from rigid.tasks.itch_scratching.playing import RightHand

        return RightHand(self.model, self.parameters)

    def describe(self) -> Mapping[str, Any]:
        """Name, version and parameters, as JSON.

        Spread itches make another version: what was described before there were any, and so does
        not speak of them, must differ from it.
        """
        described = {**super().describe(), "itch_visible": self.itch_visible}
        if self.parameters.itch_spread > 0:
            described["version"] = f"{self.version}-spread"
        return described

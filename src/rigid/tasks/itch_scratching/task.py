"""Itch scratching as a task: sizes, bounds, outcomes and worlds (`rigid/ItchScratching-v0`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import human, jaco
from rigid.tasks.itch_scratching import observation
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.scene import LIMBS, build_spec
from rigid.tasks.itch_scratching.starts import clear_starts
from rigid.tasks.itch_scratching.world import ItchScratchingWorld
from rigid.tasks.protocol import AgentSpec, Step

RETURN_RANGE = (-270.0, 450.0)
"""Returns that map to adversarialness 1 and 0, frozen for version 0: the rounded mean returns of
λ = 0 (`rigid frontier --preset paper --lambdas 0`: -91, -356 and -368) and of canonical play (454),
both with `builtin:vanilla`."""


class ItchScratching:
    """A robot arm scratches the itch of a seated person; only the person knows where it itches.

    Both agents share the reward. One of two fixed points itches, drawn per episode (any point of
    either limb at `itch_spread` 1). An episode is helped when the scratcher makes 25 counted
    contacts in 100 steps at 10 Hz.
    """

    name = "itch-scratching"
    version = 0
    feature_names = (
        *human.ARM_JOINTS,
        *(f"{joint}_velocity" for joint in human.ARM_JOINTS),
        *(f"itch_{limb}" for limb in LIMBS),
    )
    feature_units: Mapping[str, str] = {
        **dict.fromkeys(human.ARM_JOINTS, "rad"),
        **{f"{joint}_velocity": "rad/s" for joint in human.ARM_JOINTS},
    }
    shown_human = observation.ARM_NAMES
    outcome_names: tuple[str, ...] = ("helped", "unhelped", "unwanted_contact")
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
        self.parameters = parameters or ItchScratchingParameters()
        self.itch_visible = itch_visible
        self.horizon = self.parameters.horizon
        self.control_period = self.parameters.physics_step * self.parameters.substeps
        names = observation.ROBOT_SEEING_NAMES if itch_visible else observation.ROBOT_NAMES
        self.robot = AgentSpec(len(names), len(jaco.JOINT_NAMES), names)
        self.human = AgentSpec(
            len(observation.HUMAN_NAMES), len(human.ARM_JOINTS), observation.HUMAN_NAMES
        )
        self.chest = np.array([0.0, 0.03, self.parameters.body_size.chest_height])

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled scene."""
        return build_spec(self.parameters).compile()

    @cached_property
    def starts(self) -> Float[np.ndarray, "n 7"]:
        """Collision-free robot poses at the start [rad]."""
        return clear_starts(self.model)

    def seeing_the_itch(self) -> ItchScratching:
        """The same task with the itch in the robot's observation, for co-optimisation."""
        return ItchScratching(self.parameters, itch_visible=True)

    def diversified(self) -> ItchScratching:
        """The same task with the itch anywhere along both limbs."""
        return self.with_parameters(itch_spread=1.0)

    def make_world(self, batch: int, *, threads: int = 0) -> ItchScratchingWorld:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""
        return ItchScratchingWorld(self, batch, threads)

    def features(self, step: Step) -> Float[np.ndarray, "B 22"]:
        """Human joint angles [rad], velocities [rad/s] and one-hot itch; nothing of the robot."""
        return step.features

    def bounds(self, agent: str) -> Float[np.ndarray, "n 2"]:
        """Finite (low, high) of each number that `agent` observes."""
        names = {"robot": self.robot, "human": self.human}[agent].observation_names
        ranges = {name: self.model.joint(name).range for name in self._joint_names}
        robot = np.array([ranges[name] for name in jaco.JOINT_NAMES])
        arm = np.array([ranges[name] for name in human.ARM_JOINTS])
        return observation.bounds(names, robot, arm)

    _joint_names = (*jaco.JOINT_NAMES, *human.ARM_JOINTS)

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

    def human_poses(
        self, names: Sequence[str], features: Float[np.ndarray, "n f"]
    ) -> Mapping[str, Any] | None:
        """The right arm at the joint angles among the features; None where some are missing."""
        from rigid.tasks.itch_scratching import replay

        return replay.human_poses(self.model, names, features)

    def describe(self) -> Mapping[str, Any]:
        """Name, version and parameters, as JSON.

        Spread itches make another version: what was described before there were any, and so does
        not speak of them, must differ from it.
        """
        spread = self.parameters.itch_spread > 0
        return {
            "name": self.name,
            "version": f"{self.version}-spread" if spread else self.version,
            "itch_visible": self.itch_visible,
            "parameters": self.parameters.describe(),
        }

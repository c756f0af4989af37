"""Feeding as a task: sizes, bounds, outcomes and worlds (`rigid/Feeding-v0`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import head, human, jaco
from rigid.tasks.feeding import observation
from rigid.tasks.feeding.parameters import FeedingParameters
from rigid.tasks.feeding.scene import Below, build_spec
from rigid.tasks.feeding.starts import clear_starts
from rigid.tasks.feeding.world import FeedingWorld
from rigid.tasks.protocol import AgentSpec, Step

RETURN_RANGE = (-20.0, 150.0)
"""Returns that map to adversarialness 1 and 0, frozen for version 0: the rounded mean returns of
λ = 0 at the paper's budget against the bundled vanilla robot (-15.9, two seeds) and of canonical
play with it (147.8)."""


class Feeding:
    """A robot arm brings a spoon of food to the mouth of a person who moves the head.

    Both agents share the reward, and both see the mouth. An episode is helped when 6 of 8 pieces of
    food reach the mouth in 100 steps at 10 Hz.
    """

    name = "feeding"
    version = 0
    feature_names = (*head.HEAD_JOINTS, *(f"{joint}_velocity" for joint in head.HEAD_JOINTS))
    feature_units: Mapping[str, str] = {
        **dict.fromkeys(head.HEAD_JOINTS, "rad"),
        **{f"{joint}_velocity": "rad/s" for joint in head.HEAD_JOINTS},
    }
    outcome_names: tuple[str, ...] = ("helped", "unhelped", "unwanted_contact")
    return_range: tuple[float, float] | None = RETURN_RANGE

    def __init__(self, parameters: FeedingParameters | None = None) -> None:
        """Builds the task.

        Args:
            parameters: Body, impairment, physics; the reference person by default.
        """
        self.parameters = parameters or FeedingParameters()
        self.horizon = self.parameters.horizon
        self.control_period = self.parameters.physics_step * self.parameters.substeps
        self.robot = AgentSpec(
            len(observation.ROBOT_NAMES), len(jaco.JOINT_NAMES), observation.ROBOT_NAMES
        )
        self.human = AgentSpec(
            len(observation.HUMAN_NAMES), len(head.HEAD_JOINTS), observation.HUMAN_NAMES
        )
        self.chest = human.chest_origin(self.parameters.body_size)

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled scene."""
        return build_spec(self.parameters).compile()

    @cached_property
    def starts(self) -> Float[np.ndarray, "n 7"]:
        """Collision-free robot poses at the start [rad]."""
        return clear_starts(self.model)

    @cached_property
    def below(self) -> Below:
        """Where falling food lands."""
        return Below(self.parameters)

    def make_world(self, batch: int, *, threads: int = 0) -> FeedingWorld:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""
        return FeedingWorld(self, batch, threads)

    def features(self, step: Step) -> Float[np.ndarray, "B 8"]:
        """Joint angles [rad] and velocities [rad/s] of neck and head; nothing of the robot."""
        return step.features

    def bounds(self, agent: str) -> Float[np.ndarray, "n 2"]:
        """Finite (low, high) of each number that `agent` observes."""
        names = {"robot": self.robot, "human": self.human}[agent].observation_names
        joints = (*jaco.JOINT_NAMES, *head.HEAD_JOINTS)
        return observation.bounds(names, {name: self.model.joint(name).range for name in joints})

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

    def human_poses(
        self, names: Sequence[str], features: Float[np.ndarray, "n f"]
    ) -> Mapping[str, Any] | None:
        """The head at the joint angles among the features; None where some are missing."""
        from rigid.tasks.physics.drawing import chain_poses

        return chain_poses(self.model, head.HEAD_JOINTS, "neck", names, features)

    def describe(self) -> Mapping[str, Any]:
        """Name, version and parameters, as JSON."""
        return {
            "name": self.name,
            "version": self.version,
            "parameters": self.parameters.describe(),
        }

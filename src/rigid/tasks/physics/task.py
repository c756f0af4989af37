"""A task on MuJoCo: a Jaco arm assists a seated person; what such tasks do alike."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, ClassVar, Generic, TypeVar

import mujoco
import numpy as np
from jaxtyping import Float

from rigid.tasks.bodies import human, jaco
from rigid.tasks.physics import drawing, observing
from rigid.tasks.physics.parameters import Simulated
from rigid.tasks.physics.starts import Starts
from rigid.tasks.protocol import AgentSpec, Step, World

Parameters = TypeVar("Parameters", bound=Simulated)


def joint_features(joints: Sequence[str]) -> tuple[str, ...]:
    """Names of the angles of joints, then of their velocities, as the worlds have them."""
    return (*joints, *(f"{joint}_velocity" for joint in joints))


def joint_units(joints: Sequence[str]) -> dict[str, str]:
    """Units of `joint_features`."""
    names = joint_features(joints)
    return {name: "rad/s" if name.endswith("_velocity") else "rad" for name in names}


class DrivenTask(ABC, Generic[Parameters]):
    """See `rigid.tasks.protocol.Task`. A task fills in the abstract methods and what follows.

    An episode ends helped, unhelped, or with unwanted contact.
    """

    name: str
    version: int = 0
    return_range: tuple[float, float] | None
    outcome_names: tuple[str, ...] = ("helped", "unhelped", "unwanted_contact")
    moving: ClassVar[tuple[str, ...]]
    """Joints of the person that move; the human has an action for each."""
    poses_at_start: ClassVar[Starts]
    feature_names: tuple[str, ...]
    """`joint_features(moving)`, and what the human wants."""
    feature_units: Mapping[str, str]
    """`joint_units(moving)`, and those of the others that have one."""

    def __init__(
        self, parameters: Parameters, *, robot_sees: tuple[str, ...], human_sees: tuple[str, ...]
    ) -> None:
        """Builds the task.

        Args:
            parameters: Body, impairment, reward, physics.
            robot_sees: Names of the robot's observed numbers.
            human_sees: Those of the human's.
        """
        self.parameters = parameters
        self.horizon, self.control_period = parameters.horizon, parameters.control_period
        self.robot = AgentSpec(len(robot_sees), len(jaco.JOINT_NAMES), robot_sees)
        self.human = AgentSpec(len(human_sees), len(self.moving), human_sees)
        self.chest = human.chest_origin(parameters.body_size)

    @abstractmethod
    def build_spec(self) -> mujoco.MjSpec:
        """The scene, with its sensors."""

    @abstractmethod
    def make_world(self, batch: int, *, threads: int = 0) -> World:
        """Returns `batch` worlds stepped on `threads` threads (0: every core)."""

    @abstractmethod
    def scene(self) -> Mapping[str, Any]:
        """Bodies and shapes as the report draws them."""

    @abstractmethod
    def replay(self, snapshots: Float[np.ndarray, "T1 state"]) -> Mapping[str, Any]:
        """Poses, forces and contacts of one episode as the report shows them."""

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled scene."""
        return self.build_spec().compile()

    @cached_property
    def starts(self) -> Float[np.ndarray, "n 7"]:
        """Collision-free robot poses at the start [rad]."""
        return self.poses_at_start.clear(self.model)

    def features(self, step: Step) -> Float[np.ndarray, "B features"]:
        """Angles [rad] and velocities [rad/s] of the person's joints, and what the human wants."""
        return step.features

    def bounds(self, agent: str) -> Float[np.ndarray, "n 2"]:
        """Finite (low, high) of each number that `agent` observes."""
        names = {"robot": self.robot, "human": self.human}[agent].observation_names
        joints = (*jaco.JOINT_NAMES, *self.moving)
        return observing.bounds(names, {name: self.model.joint(name).range for name in joints})

    def human_poses(
        self, names: Sequence[str], features: Float[np.ndarray, "n f"]
    ) -> Mapping[str, Any] | None:
        """What moves of the person, at the angles among the features; None where some miss."""
        return drawing.chain_poses(self.model, self.moving, names, features)

    def describe(self) -> Mapping[str, Any]:
        """Name, version and parameters, as JSON."""
        return {
            "name": self.name, "version": self.version, "parameters": self.parameters.describe(),
        }  # fmt: skip

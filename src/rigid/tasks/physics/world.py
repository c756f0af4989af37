"""B episodes of a task on MuJoCo's native batch: all that such tasks do alike."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NamedTuple, TypeVar

import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.tasks.bodies import jaco
from rigid.tasks.physics.scene import driven_addresses
from rigid.tasks.physics.sensing import PersonContacts
from rigid.tasks.physics.stepping import TARGET_AHEAD, SteppedScene
from rigid.tasks.physics.tally import ForceTally
from rigid.tasks.protocol import Step, Summary

if TYPE_CHECKING:
    from rigid.tasks.physics.task import DrivenTask

DrivenTaskT = TypeVar("DrivenTaskT", bound="DrivenTask[Any]")
Contacts = TypeVar("Contacts", bound=PersonContacts)
Poses = TypeVar("Poses")


class Scored(NamedTuple):
    """What a task makes of a control step."""

    terms: Mapping[str, Float[np.ndarray, " B"]]
    """Named reward terms; those of worlds that ran away are dropped."""
    measured: Mapping[str, np.ndarray]
    """For `Step.info`, each [B]."""
    forces: Float[np.ndarray, "B f"]
    """Those that are observed, at the last physics step [N]."""


class DrivenWorld(ABC, Generic[DrivenTaskT, Contacts, Poses]):
    """Steps B episodes; see `rigid.tasks.protocol.World`. A task fills in the abstract methods.

    Contact forces cover every physics step of a control step. Poses and distances are those at the
    start of its last physics step (0.02 s old; MuJoCo's sensors describe the state before a step);
    joint angles and velocities are current.
    """

    forces_seen: ClassVar[int]
    """Number of forces that are observed."""

    def __init__(self, task: DrivenTaskT, batch: int, threads: int) -> None:
        self.batch, self._task, self._parameters = batch, task, task.parameters
        self._scene = SteppedScene(
            task.model, batch, threads=threads, substeps=task.parameters.substeps
        )
        self._batch = self._scene.batch
        self._person = driven_addresses(task.model, task.moving)
        self._robot = driven_addresses(task.model, jaco.JOINT_NAMES)
        self._begin(np.zeros(batch, dtype=np.int64))

    @abstractmethod
    def _clear(self) -> None:
        """Sets what an episode counts, and what no seed draws, to its beginning."""

    @abstractmethod
    def _draw(self, world: int, rng: np.random.Generator) -> None:
        """Draws one episode; a change of what is drawn, or of its order, changes every start."""

    @abstractmethod
    def _contacts(self, data: Float[np.ndarray, "B S n"]) -> Contacts:
        """The contacts of a control step, from its sensors."""

    @abstractmethod
    def _poses(self, data: Float[np.ndarray, "B S n"]) -> Poses:
        """Where things are, from the sensors of a control step or of a start (S = 1)."""

    @abstractmethod
    def _score(self, action: Float[np.ndarray, "B a"], contacts: Contacts, poses: Poses) -> Scored:
        """Rewards a control step and counts what happened in it; `faulted` worlds count nothing."""

    @abstractmethod
    def _see(
        self, poses: Poses, forces: Float[np.ndarray, "B f"]
    ) -> tuple[Float[np.ndarray, "B r"], Float[np.ndarray, "B h"]]:
        """What robot and human observe."""

    @abstractmethod
    def _helped(self) -> Bool[np.ndarray, " B"]:
        """Whether the episodes have succeeded; those that ran away have not, whatever it says."""

    @abstractmethod
    def _counts(self) -> dict[str, Int[np.ndarray, " B"]]:
        """For `Summary.extra`: arrays of its own."""

    @abstractmethod
    def _shown(self) -> list[Float[np.ndarray, "B k"]]:
        """Columns of a snapshot after angles, velocities and targets."""

    def _wanted(self) -> list[np.ndarray]:
        """Columns [B, k] of the features after the joints: what the human wants; if anything."""
        return []

    def _begin(self, seeds: np.ndarray) -> None:
        """Draws each episode from its own seed."""
        self._start = np.zeros((self.batch, self._task.model.nq))
        self._tremor = np.zeros((self.batch, len(self._person)))
        self._forces = ForceTally(self.batch)
        self._time = 0
        self._clear()
        for world, seed in enumerate(seeds):
            self._draw(world, np.random.default_rng(int(seed)))

    def _draw_robot(self, world: int, rng: np.random.Generator) -> None:
        """Draws one of the robot's starts."""
        starts = self._task.starts
        self._start[world, self._robot] = starts[rng.integers(len(starts))]

    def _draw_tremor(self, world: int, rng: np.random.Generator) -> None:
        """Draws how far the tremor turns each of the person's joints."""
        amplitude = np.deg2rad(self._parameters.tremor_deg)
        self._tremor[world] = rng.uniform(-amplitude, amplitude, len(self._person))

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world; the same seed gives the same start in any world."""
        if len(seeds) != self.batch:
            raise ValueError(f"{self.batch} worlds need as many seeds, not {len(seeds)}")
        self._begin(np.asarray(seeds))
        poses = self._poses(self._scene.begin(self._start)[:, None])
        untouched = np.zeros((self.batch, self.forces_seen))
        return self._observe(poses, untouched, np.zeros(self.batch), {})

    @property
    def faulted(self) -> Bool[np.ndarray, " B"]:
        """Worlds whose physics ran away in this episode."""
        return self._scene.faulted

    def step(
        self, robot_action: Float[np.ndarray, "B 7"], human_action: Float[np.ndarray, "B h"]
    ) -> Step:
        """Advances every world by one control step; actions are clipped to [-1, 1]."""
        action = np.zeros((self.batch, self._task.model.nu))
        action[:, self._robot] = np.clip(robot_action, -1, 1)
        action[:, self._person] = np.clip(human_action, -1, 1)
        target = self._batch.bind("qpos") + TARGET_AHEAD * action
        target[:, self._person] += self._tremor * (1 if self._time % 2 else -1)
        data = self._scene.step(target)
        self._time += 1
        action[self.faulted] = 0.0  # It may not have been finite.
        contacts, poses = self._contacts(data), self._poses(data)
        return self._reward(contacts, poses, self._score(action, contacts, poses))

    def _reward(self, contacts: Contacts, poses: Poses, scored: Scored) -> Step:
        alive, force = ~self.faulted, contacts.force_on_person
        terms = {name: value * alive for name, value in scored.terms.items()}
        self._forces.add(force, contacts.touched_unwanted, alive, self._parameters.physics_step)
        info = {
            **{f"reward_{name}": value for name, value in terms.items()},
            **scored.measured,
            "force_unwanted": contacts.force_unwanted.max(axis=1),
            "force_on_person": force.max(axis=1),
        }
        return self._observe(poses, scored.forces, np.sum(list(terms.values()), axis=0), info)

    def _observe(
        self,
        poses: Poses,
        forces: Float[np.ndarray, "B f"],
        reward: Float[np.ndarray, " B"],
        info: dict[str, np.ndarray],
    ) -> Step:
        robot, person = self._see(poses, forces)
        angles, speeds = (self._batch.bind(name)[:, self._person] for name in ("qpos", "qvel"))
        features = np.concatenate([angles, speeds, *self._wanted()], axis=1).astype(np.float32)
        return Step(robot, person, reward, features, self.faulted.copy(), info)

    def _angles(self) -> tuple[Float[np.ndarray, "B 7"], Float[np.ndarray, "B h"]]:
        """Joint angles of robot and person [rad]."""
        angles = self._batch.bind("qpos")
        return angles[:, self._robot], angles[:, self._person]

    def summary(self) -> Summary:
        """How the current episodes stand: helped, unhelped or unwanted contact."""
        helped, forces = self._helped() & ~self.faulted, self._forces
        return Summary(
            success=helped.astype(np.float64),
            outcome=np.where(helped, 0, np.where(forces.unwanted_steps > 0, 2, 1)),
            peak_force=forces.peak.copy(),
            impulse=forces.impulse.copy(),
            extra={**self._counts(), "unwanted_contact_steps": forces.unwanted_steps.copy()},
        )

    def keep_motion(self) -> None:
        """Records the motion within control steps from now on."""
        self._scene.keep_motion()

    def motion(self) -> Float[np.ndarray, "B S nq"]:
        """Joint angles [rad] after each physics step of the last control step."""
        return self._scene.motion()

    def snapshot(self) -> Float[np.ndarray, "B state"]:
        """Angles [rad], velocities [rad/s], targets of the step [rad], and what a task adds."""
        parts = [self._batch.bind(name) for name in ("qpos", "qvel", "ctrl")]
        return np.concatenate([*parts, *self._shown()], axis=1).astype(np.float32)

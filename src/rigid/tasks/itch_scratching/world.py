"""B itch-scratching episodes on MuJoCo's native batch: the only place that holds physics state."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.tasks.bodies import human, jaco
from rigid.tasks.itch_scratching import reward as rewards
from rigid.tasks.itch_scratching.observation import observe
from rigid.tasks.itch_scratching.scene import LIMBS
from rigid.tasks.itch_scratching.sensing import Contacts, Poses, Sensors
from rigid.tasks.physics.scene import driven_addresses
from rigid.tasks.physics.stepping import TARGET_AHEAD, SteppedScene
from rigid.tasks.physics.tally import ForceTally
from rigid.tasks.protocol import Step, Summary

if TYPE_CHECKING:
    from rigid.tasks.itch_scratching.task import ItchScratching


class ItchScratchingWorld:
    """Steps B episodes; see `rigid.tasks.protocol.World`.

    Contact forces cover every physics step of a control step. Poses and distances are those at the
    start of its last physics step (0.02 s old; MuJoCo's sensors describe the state before a step);
    joint angles and velocities are current.
    """

    def __init__(self, task: ItchScratching, batch: int, threads: int) -> None:
        self.batch, self._task = batch, task
        self._parameters = task.parameters
        model = task.model
        self._sensors = Sensors(model)
        self._scene = SteppedScene(
            model,
            batch,
            threads=threads,
            substeps=self._parameters.substeps,
            penetration=self._sensors.penetration,
        )
        self._batch, self._records = self._scene.batch, self._scene.records
        self._arm = driven_addresses(model, human.ARM_JOINTS)
        self._robot = driven_addresses(model, jaco.JOINT_NAMES)
        # The middle of a limb lies half its length below the joint that it hangs from.
        self._half_lengths = np.array([-model.site(f"itch_{limb}").pos[2] for limb in LIMBS])
        self._begin(np.zeros(batch, dtype=np.int64))

    def _begin(self, seeds: np.ndarray) -> None:
        """Draws start, itch and tremor of each episode from its own seed."""
        arm_size, starts = len(self._arm), self._task.starts
        self.itch = np.zeros(self.batch, dtype=np.int64)
        self._start = np.zeros((self.batch, self._task.model.nq))
        self._tremor = np.zeros((self.batch, arm_size))
        share = np.zeros(self.batch)
        limbs = [LIMBS.index(limb) for limb in self._parameters.itch_limbs]
        amplitude, spread = np.deg2rad(self._parameters.tremor_deg), self._parameters.itch_spread
        self._start[:, self._arm] = human.start_angles()
        for world, seed in enumerate(seeds):
            rng = np.random.default_rng(int(seed))
            self._start[world, self._robot] = starts[rng.integers(len(starts))]
            self.itch[world] = limbs[rng.integers(len(limbs))]
            self._tremor[world] = rng.uniform(-amplitude, amplitude, arm_size)
            if spread:  # Last, so that the rest of an episode starts alike at any spread.
                share[world] = rng.uniform(-spread, spread)
        self._shift = share[:, None] * self._half_lengths[None, :] if spread else None
        self._last_counted = np.zeros((self.batch, 3))
        self.counted = np.zeros(self.batch, dtype=np.int64)
        self.contact_steps = np.zeros(self.batch, dtype=np.int64)
        self._forces = ForceTally(self.batch)
        self._time = 0

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world; the same seed gives the same start in any world."""
        if len(seeds) != self.batch:
            raise ValueError(f"{self.batch} worlds need as many seeds, not {len(seeds)}")
        self._begin(np.asarray(seeds))
        poses = self._sensors.poses(self._scene.begin(self._start), self._shift)
        return self._observe(poses, np.zeros((self.batch, 3)), np.zeros(self.batch), {})

    @property
    def faulted(self) -> Bool[np.ndarray, " B"]:
        """Worlds whose physics ran away in this episode."""
        return self._scene.faulted

    def step(
        self, robot_action: Float[np.ndarray, "B 7"], human_action: Float[np.ndarray, "B 10"]
    ) -> Step:
        """Advances every world by one control step of 0.1 s; actions are clipped to [-1, 1]."""
        action = np.zeros((self.batch, self._task.model.nu))
        action[:, self._robot] = np.clip(robot_action, -1, 1)
        action[:, self._arm] = np.clip(human_action, -1, 1)
        target = self._batch.bind("qpos") + TARGET_AHEAD * action
        target[:, self._arm] += self._tremor * (1 if self._time % 2 else -1)
        data = self._scene.step(target)
        self._time += 1
        action[self.faulted] = 0.0  # It may not have been finite.
        contacts = self._sensors.contacts(data, self.itch, self._shift)
        poses = self._sensors.poses(data[:, -1], self._shift)
        return self._score(action, contacts, poses)

    def _score(self, action: np.ndarray, contacts: Contacts, poses: Poses) -> Step:
        itch = poses.itches[np.arange(self.batch), self.itch]
        distance = np.linalg.norm(poses.tip - itch, axis=1)
        counted = rewards.counted_contacts(contacts, self._last_counted)
        self._last_counted = np.where(counted[:, None], contacts.itch_contact, self._last_counted)
        terms = rewards.reward_terms(
            self._parameters.weights,
            distance=distance,
            counted=counted,
            action=action,
            end_effector_speed=poses.end_effector_speed,
            contacts=contacts,
        )
        alive = ~self.faulted
        terms = {name: value * alive for name, value in terms.items()}
        self.counted += counted & alive
        self.contact_steps += contacts.itch_touched & alive
        force = contacts.force_on_person
        self._forces.add(force, contacts.touched_unwanted, alive, self._parameters.physics_step)
        forces = np.stack([contacts.tool_force, force[:, -1], contacts.force_itch[:, -1]], axis=1)
        reward = np.sum(list(terms.values()), axis=0)
        info = {
            **{f"reward_{name}": value for name, value in terms.items()},
            "distance": distance,
            "counted": counted,
            "force_itch": contacts.force_itch.max(axis=1),
            "force_unwanted": contacts.force_unwanted.max(axis=1),
            "force_on_person": force.max(axis=1),
        }
        return self._observe(poses, forces, reward, info)

    def _observe(
        self, poses: Poses, forces: np.ndarray, reward: np.ndarray, info: dict[str, np.ndarray]
    ) -> Step:
        angles, speeds = self._batch.bind("qpos"), self._batch.bind("qvel")
        robot, person = observe(
            poses,
            poses.itches[np.arange(self.batch), self.itch],
            angles[:, self._robot],
            angles[:, self._arm],
            forces,
            self._task.chest,
            itch_visible=self._task.itch_visible,
        )
        one_hot = np.eye(len(LIMBS))[self.itch]
        features = np.concatenate([angles[:, self._arm], speeds[:, self._arm], one_hot], axis=1)
        return Step(robot, person, reward, features.astype(np.float32), self.faulted.copy(), info)

    def summary(self) -> Summary:
        """How the current episodes stand: helped, unhelped or unwanted contact."""
        helped = (self.counted >= rewards.SUCCESS_CONTACTS) & ~self.faulted
        touched = self._forces.unwanted_steps > 0
        outcome = np.where(helped, 0, np.where(touched, 2, 1))
        return Summary(
            success=helped.astype(np.float64),
            outcome=outcome,
            peak_force=self._forces.peak.copy(),
            impulse=self._forces.impulse.copy(),
            extra={
                "counted_contacts": self.counted.copy(),
                "contact_steps": self.contact_steps.copy(),
                "unwanted_contact_steps": self._forces.unwanted_steps.copy(),
            },
        )

    def snapshot(self) -> Float[np.ndarray, "B state"]:
        """Angles [rad], velocities [rad/s], targets of the step [rad], itch, counted contacts.

        Where itches are spread, how far below the middle of its limb [m] comes before the itch.
        """
        parts = [self._batch.bind(name) for name in ("qpos", "qvel", "ctrl")]
        columns = [self.itch[:, None], self.counted[:, None]]
        if self._shift is not None:
            columns.insert(0, self._shift[np.arange(self.batch), self.itch][:, None])
        return np.concatenate([*parts, *columns], axis=1).astype(np.float32)

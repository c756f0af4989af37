"""B itch-scratching episodes on MuJoCo's native batch: the only place that holds physics state."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from jaxtyping import Float, Int
from mujoco.batch import Batch

from rigid.tasks.bodies import human, jaco
from rigid.tasks.itch_scratching import reward as rewards
from rigid.tasks.itch_scratching.observation import observe
from rigid.tasks.itch_scratching.scene import LIMBS
from rigid.tasks.itch_scratching.sensing import Contacts, Poses, Sensors
from rigid.tasks.protocol import Step, Summary

if TYPE_CHECKING:
    from rigid.tasks.itch_scratching.task import ItchScratching

TARGET_AHEAD = 0.25
"""A full action puts the target this far ahead of the measured angle [rad] (Assistive Gym)."""
MAX_SPEED = 50.0
"""A joint faster than this has run away [rad/s] (ours)."""
MAX_PENETRATION = 0.02
"""Bodies deeper in each other than this have run away [m] (ours)."""


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
        if mujoco.get_mju_user_warning() is None:
            # Faults are counted here; MuJoCo would log each to a file in the working directory.
            mujoco.set_mju_user_warning(lambda _: None)
        self._batch = Batch(model, batch, threads)
        # Bound before the first call: a field that is bound later reads 0 until the next one.
        self._sensordata = self._batch.bind("sensordata")
        self._sensors = Sensors(model)
        self._arm = _addresses(model, human.ARM_JOINTS)
        self._robot = _addresses(model, jaco.JOINT_NAMES)
        self._limits = model.jnt_range.copy()
        # The middle of a limb lies half its length below the joint that it hangs from.
        self._half_lengths = np.array([-model.site(f"itch_{limb}").pos[2] for limb in LIMBS])
        self._records = {"sensordata": np.zeros((batch, task.parameters.substeps,
                                                 model.nsensordata))}  # fmt: skip
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
        self._unwanted_steps = np.zeros(self.batch, dtype=np.int64)
        self._peak_force = np.zeros(self.batch)
        self._impulse = np.zeros(self.batch)
        self.faulted = np.zeros(self.batch, dtype=bool)
        self._time = 0

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world; the same seed gives the same start in any world."""
        if len(seeds) != self.batch:
            raise ValueError(f"{self.batch} worlds need as many seeds, not {len(seeds)}")
        self._begin(np.asarray(seeds))
        self._put_at_start(np.arange(self.batch, dtype=np.int32))
        poses = self._sensors.poses(self._sensordata.copy(), self._shift)
        return self._observe(poses, np.zeros((self.batch, 3)), np.zeros(self.batch), {})

    def _put_at_start(self, worlds: np.ndarray) -> None:
        self._batch.reset(worlds, stage=mujoco.mjtStage.mjSTAGE_NONE.value)
        self._batch.bind("qpos")[worlds] = self._start[worlds]
        self._batch.bind("ctrl")[worlds] = self._start[worlds]
        self._batch.forward(worlds)  # Sensors are zero until a forward pass.

    def step(
        self, robot_action: Float[np.ndarray, "B 7"], human_action: Float[np.ndarray, "B 10"]
    ) -> Step:
        """Advances every world by one control step of 0.1 s; actions are clipped to [-1, 1]."""
        action = np.zeros((self.batch, self._task.model.nu))
        action[:, self._robot] = np.clip(robot_action, -1, 1)
        action[:, self._arm] = np.clip(human_action, -1, 1)
        target = self._batch.bind("qpos") + TARGET_AHEAD * action
        target[:, self._arm] += self._tremor * (1 if self._time % 2 else -1)
        self._batch.bind("ctrl")[:] = np.clip(target, *self._limits.T)
        self._batch.rollout(self._parameters.substeps, record=("sensordata",), out=self._records)
        self._time += 1
        self._restart_faulted()
        action[self.faulted] = 0.0  # It may not have been finite.
        data = self._records["sensordata"]
        contacts = self._sensors.contacts(data, self.itch, self._shift)
        poses = self._sensors.poses(data[:, -1], self._shift)
        return self._score(action, contacts, poses)

    def _restart_faulted(self) -> None:
        """Puts worlds whose physics ran away back to their start and marks them for good."""
        speed, angle = self._batch.bind("qvel"), self._batch.bind("qpos")
        data = self._records["sensordata"]
        broken = ~(np.abs(speed) < MAX_SPEED).all(axis=1) | ~np.isfinite(angle).all(axis=1)
        broken |= ~np.isfinite(data).all(axis=(1, 2)) | (self._batch.status != 0)
        # A warning (bad control, full buffers) ends the world's control step early.
        broken |= self._batch.warning[..., 1].any(axis=1)
        broken |= self._sensors.penetration(data) > MAX_PENETRATION
        if broken.any():
            worlds = np.flatnonzero(broken).astype(np.int32)
            self._put_at_start(worlds)
            data[worlds] = self._sensordata[worlds][:, None]
            self.faulted[worlds] = True

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
        self._unwanted_steps += contacts.touched_unwanted & alive
        force = contacts.force_on_person
        self._peak_force = np.maximum(self._peak_force, force.max(axis=1) * alive)
        self._impulse += force.sum(axis=1) * self._parameters.physics_step * alive
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
        touched = self._unwanted_steps > 0
        outcome = np.where(helped, 0, np.where(touched, 2, 1))
        return Summary(
            success=helped.astype(np.float64),
            outcome=outcome,
            peak_force=self._peak_force.copy(),
            impulse=self._impulse.copy(),
            extra={
                "counted_contacts": self.counted.copy(),
                "contact_steps": self.contact_steps.copy(),
                "unwanted_contact_steps": self._unwanted_steps.copy(),
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


def _addresses(model: mujoco.MjModel, names: tuple[str, ...]) -> np.ndarray:
    """Positions in qpos, qvel and ctrl (equal here: every joint is a driven hinge)."""
    addresses = np.array([model.joint(name).qposadr[0] for name in names])
    driven = [model.actuator(f"{name}_servo").id for name in names]
    if not np.array_equal(addresses, driven):
        raise ValueError(f"joints {names} are not driven in order: {addresses} != {driven}")
    return addresses

"""B feeding episodes on MuJoCo's native batch: the only place that holds physics state."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.tasks.bodies import head, jaco
from rigid.tasks.feeding import food as foods
from rigid.tasks.feeding import reward as rewards
from rigid.tasks.feeding.food import Piece
from rigid.tasks.feeding.observation import observe
from rigid.tasks.feeding.sensing import Contacts, Poses, Sensors
from rigid.tasks.physics.scene import driven_addresses
from rigid.tasks.physics.stepping import TARGET_AHEAD, SteppedScene
from rigid.tasks.physics.tally import ForceTally
from rigid.tasks.protocol import Step, Summary

if TYPE_CHECKING:
    from rigid.tasks.feeding.task import Feeding


class FeedingWorld:
    """Steps B episodes; see `rigid.tasks.protocol.World`.

    Contact forces and food that reaches the mouth cover every physics step of a control step. Poses
    and distances are those at the start of its last physics step (0.02 s old; MuJoCo's sensors
    describe the state before a step); joint angles and velocities are current.
    """

    def __init__(self, task: Feeding, batch: int, threads: int) -> None:
        self.batch, self._task, self._parameters = batch, task, task.parameters
        self._sensors = Sensors(task.model)
        self._scene = SteppedScene(
            task.model,
            batch,
            threads=threads,
            substeps=self._parameters.substeps,
            penetration=self._sensors.penetration,
        )
        self._batch = self._scene.batch
        self._head = driven_addresses(task.model, head.HEAD_JOINTS)
        self._robot = driven_addresses(task.model, jaco.JOINT_NAMES)
        self._begin(np.zeros(batch, dtype=np.int64))

    def _begin(self, seeds: np.ndarray) -> None:
        """Draws start, head and tremor of each episode from its own seed."""
        joints, starts = len(self._head), self._task.starts
        self._start = np.zeros((self.batch, self._task.model.nq))
        self._tremor = np.zeros((self.batch, joints))
        spread = np.deg2rad(self._parameters.head_start_deg)
        amplitude = np.deg2rad(self._parameters.tremor_deg)
        low, high = self._task.model.jnt_range[self._head].T
        for world, seed in enumerate(seeds):
            rng = np.random.default_rng(int(seed))
            self._start[world, self._robot] = starts[rng.integers(len(starts))]
            turned = rng.uniform(-spread, spread, joints)
            turned[0] = 0.0  # The original turns the head, not the neck.
            self._start[world, self._head] = np.clip(turned, low, high)
            self._tremor[world] = rng.uniform(-amplitude, amplitude, joints)
        self.food = np.full((self.batch, len(foods.PIECES)), Piece.HELD, dtype=np.int64)
        self._on_person = np.zeros(self.batch, dtype=np.int64)
        self._contact_steps = np.zeros(self.batch, dtype=np.int64)
        self._velocity = np.zeros((self.batch, 3))
        self._forces = ForceTally(self.batch)
        self._time = 0

    def reset(self, seeds: Int[np.ndarray, " B"]) -> Step:
        """Starts an episode in every world; the same seed gives the same start in any world."""
        if len(seeds) != self.batch:
            raise ValueError(f"{self.batch} worlds need as many seeds, not {len(seeds)}")
        self._begin(np.asarray(seeds))
        poses = self._sensors.poses(self._scene.begin(self._start))
        return self._observe(poses, np.zeros((self.batch, 2)), np.zeros(self.batch), {})

    @property
    def faulted(self) -> Bool[np.ndarray, " B"]:
        """Worlds whose physics ran away in this episode."""
        return self._scene.faulted

    def step(
        self, robot_action: Float[np.ndarray, "B 7"], human_action: Float[np.ndarray, "B 4"]
    ) -> Step:
        """Advances every world by one control step of 0.1 s; actions are clipped to [-1, 1]."""
        action = np.zeros((self.batch, self._task.model.nu))
        action[:, self._robot] = np.clip(robot_action, -1, 1)
        action[:, self._head] = np.clip(human_action, -1, 1)
        target = self._batch.bind("qpos") + TARGET_AHEAD * action
        target[:, self._head] += self._tremor * (1 if self._time % 2 else -1)
        data = self._scene.step(target)
        self._time += 1
        action[self.faulted] = 0.0  # It may not have been finite.
        return self._score(action, self._sensors.contacts(data), self._sensors.poses(data))

    def _score(self, action: np.ndarray, contacts: Contacts, poses: Poses) -> Step:
        events, last = self._feed(poses), poses.last()
        distance = np.linalg.norm(last.spoon - last.mouth, axis=1)
        terms = rewards.reward_terms(
            self._parameters.weights,
            distance=distance,
            food=events,
            action=action,
            end_effector_speed=last.end_effector_speed,
            spoon_speed=np.linalg.norm(last.spoon_velocity, axis=1),
            contacts=contacts,
        )
        alive = ~self.faulted
        terms = {name: value * alive for name, value in terms.items()}
        force = contacts.force_on_person
        self._contact_steps += (force > 0).any(axis=1) & alive
        self._forces.add(force, contacts.touched_unwanted, alive, self._parameters.physics_step)
        arm_force = np.maximum(force[:, -1] - contacts.force_spoon[:, -1], 0.0)
        forces = np.stack([arm_force, contacts.force_spoon[:, -1]], axis=1)
        reward = np.sum(list(terms.values()), axis=0)
        info = {
            **{f"reward_{name}": value for name, value in terms.items()},
            "distance": distance,
            "eaten": events.eaten,
            "spilled": events.spilled,
            "force_mouth": contacts.force_mouth.max(axis=1),
            "force_unwanted": contacts.force_unwanted.max(axis=1),
            "force_on_person": force.max(axis=1),
        }
        return self._observe(last, forces, reward, info)

    def _feed(self, poses: Poses) -> rewards.FoodEvents:
        """Moves food from the spoon to the mouth or off the spoon; a faulted world's stays."""
        alive = ~self.faulted[:, None]
        where = foods.places(poses.spoon, poses.spoon_quaternion)
        eaten = foods.eaten_now(self.food, where, poses.mouth) & alive
        self.food[eaten] = Piece.EATEN
        last = poses.last()
        control = self._parameters.physics_step * self._parameters.substeps
        acceleration = (last.spoon_velocity - self._velocity) / control
        self._velocity = last.spoon_velocity
        angle = foods.tilt(last.spoon_quaternion, acceleration)
        spilled = foods.spilled_now(self.food, angle) & alive
        self.food[spilled] = Piece.SPILLED
        on_person = (spilled & self._task.below(where[:, -1])[1]).sum(axis=1)
        self._on_person += on_person
        return rewards.FoodEvents(eaten.sum(axis=1), spilled.sum(axis=1), on_person)

    def _observe(
        self, poses: Poses, forces: np.ndarray, reward: np.ndarray, info: dict[str, np.ndarray]
    ) -> Step:
        angles, speeds = self._batch.bind("qpos"), self._batch.bind("qvel")
        robot, person = observe(
            poses, angles[:, self._robot], angles[:, self._head], forces, self._task.chest
        )
        features = np.concatenate([angles[:, self._head], speeds[:, self._head]], axis=1)
        return Step(robot, person, reward, features.astype(np.float32), self.faulted.copy(), info)

    def summary(self) -> Summary:
        """How the current episodes stand: helped, unhelped or unwanted contact."""
        eaten = (self.food == Piece.EATEN).sum(axis=1)
        helped = (eaten >= foods.ENOUGH) & ~self.faulted
        touched = self._forces.unwanted_steps > 0
        return Summary(
            success=helped.astype(np.float64),
            outcome=np.where(helped, 0, np.where(touched, 2, 1)),
            peak_force=self._forces.peak.copy(),
            impulse=self._forces.impulse.copy(),
            extra={
                "eaten": eaten,
                "spilled": (self.food == Piece.SPILLED).sum(axis=1),
                "spilled_on_person": self._on_person.copy(),
                "contact_steps": self._contact_steps.copy(),
                "unwanted_contact_steps": self._forces.unwanted_steps.copy(),
            },
        )

    def snapshot(self) -> Float[np.ndarray, "B state"]:
        """Angles [rad], velocities [rad/s], targets of the step [rad], `Piece` of each piece."""
        parts = [self._batch.bind(name) for name in ("qpos", "qvel", "ctrl")]
        return np.concatenate([*parts, self.food], axis=1).astype(np.float32)

"""B bed-bathing episodes: what is drawn, what is wiped, what is seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.tasks.bed_bathing import reward as rewards
from rigid.tasks.bed_bathing.observation import observe
from rigid.tasks.bed_bathing.points import wiped_now
from rigid.tasks.bed_bathing.sensing import Contacts, Poses, Sensors
from rigid.tasks.bodies import human, lying
from rigid.tasks.physics.world import DrivenWorld, Scored

if TYPE_CHECKING:
    from rigid.tasks.bed_bathing.task import BedBathing

_ON_THE_BED = np.isin(human.ARM_JOINTS, ("pecs_x", "pecs_z", "shoulder_y"))
"""Joints that would press the arm into the bed, or lift it off: they start as they lie."""


class BedBathingWorld(DrivenWorld["BedBathing", Contacts, Poses]):
    """Steps B episodes; see `rigid.tasks.protocol.World`.

    Touches of the pad are looked at after every physics step. A snapshot ends with a number for
    each point of the arm: 1 where it is wiped, else 0.
    """

    forces_seen = 3

    def __init__(self, task: BedBathing, batch: int, threads: int) -> None:
        self._sensors = Sensors(task.model)
        super().__init__(task, batch, threads)

    def _clear(self) -> None:
        self._start[:, self._person] = lying.start_angles(self._parameters.body_size)
        self.wiped = np.zeros((self.batch, len(self._task.points.limb)), dtype=bool)
        self._contact_steps = np.zeros(self.batch, dtype=np.int64)

    def _draw(self, world: int, rng: np.random.Generator) -> None:
        self._draw_robot(world, rng)
        spread = np.deg2rad(self._parameters.arm_start_deg)
        turned = np.where(_ON_THE_BED, 0.0, rng.uniform(-spread, spread, len(self._person)))
        limits = self._task.model.jnt_range[self._person]
        start = self._start[world, self._person] + turned
        self._start[world, self._person] = np.clip(start, *limits.T)
        self._draw_tremor(world, rng)

    def _contacts(self, data: Float[np.ndarray, "B S n"]) -> Contacts:
        return self._sensors.contacts(data)

    def _poses(self, data: Float[np.ndarray, "B S n"]) -> Poses:
        return self._sensors.poses(data[:, -1])

    def _score(self, action: Float[np.ndarray, "B a"], contacts: Contacts, poses: Poses) -> Scored:
        alive, force = ~self.faulted, contacts.force_pad
        touched = wiped_now(self._task.points, contacts.touching, contacts.places)
        fresh = touched & ~self.wiped & alive[:, None]
        self.wiped |= fresh
        self._contact_steps += (force > 0).any(axis=1) & alive
        terms = rewards.reward_terms(
            self._parameters.weights,
            distance=poses.distance,
            wiped=fresh.sum(axis=1),
            action=action,
            end_effector_speed=poses.end_effector_speed,
            contacts=contacts,
        )
        measured = {
            "distance": poses.distance,
            "wiped": fresh.sum(axis=1),
            "force_pad": force.max(axis=1),
        }
        seen = [contacts.tool_force, contacts.force_on_person[:, -1], force[:, -1]]
        return Scored(terms, measured, np.stack(seen, axis=1))

    def _see(
        self, poses: Poses, forces: Float[np.ndarray, "B f"]
    ) -> tuple[Float[np.ndarray, "B r"], Float[np.ndarray, "B h"]]:
        return observe(poses, *self._angles(), forces, self._task.chest)

    def _helped(self) -> Bool[np.ndarray, " B"]:
        return np.asarray(self.wiped.sum(axis=1) >= self._task.points.enough)

    def _counts(self) -> dict[str, Int[np.ndarray, " B"]]:
        return {"wiped": self.wiped.sum(axis=1), "contact_steps": self._contact_steps.copy()}

    def _shown(self) -> list[np.ndarray]:
        return [self.wiped]

"""B feeding episodes: what is drawn, what becomes of the food, what is seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.tasks.feeding import food as foods
from rigid.tasks.feeding import reward as rewards
from rigid.tasks.feeding.food import Piece
from rigid.tasks.feeding.observation import observe
from rigid.tasks.feeding.sensing import Contacts, Poses, Sensors
from rigid.tasks.physics.world import DrivenWorld, Scored

if TYPE_CHECKING:
    from rigid.tasks.feeding.task import Feeding


class FeedingWorld(DrivenWorld["Feeding", Contacts, Poses]):
    """Steps B episodes; see `rigid.tasks.protocol.World`.

    Food that reaches the mouth is looked at after every physics step. A snapshot ends with the
    `Piece` of each piece of food.
    """

    forces_seen = 2

    def __init__(self, task: Feeding, batch: int, threads: int) -> None:
        self._sensors = Sensors(task.model)
        super().__init__(task, batch, threads)

    def _clear(self) -> None:
        self.food = np.full((self.batch, len(foods.PIECES)), Piece.HELD, dtype=np.int64)
        self._on_person = np.zeros(self.batch, dtype=np.int64)
        self._contact_steps = np.zeros(self.batch, dtype=np.int64)
        self._velocity = np.zeros((self.batch, 3))

    def _draw(self, world: int, rng: np.random.Generator) -> None:
        self._draw_robot(world, rng)
        spread = np.deg2rad(self._parameters.head_start_deg)
        turned = rng.uniform(-spread, spread, len(self._person))
        turned[0] = 0.0  # The original turns the head, not the neck.
        limits = self._task.model.jnt_range[self._person]
        self._start[world, self._person] = np.clip(turned, *limits.T)
        self._draw_tremor(world, rng)

    def _contacts(self, data: Float[np.ndarray, "B S n"]) -> Contacts:
        return self._sensors.contacts(data)

    def _poses(self, data: Float[np.ndarray, "B S n"]) -> Poses:
        return self._sensors.poses(data)

    def _score(self, action: Float[np.ndarray, "B a"], contacts: Contacts, poses: Poses) -> Scored:
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
        force = contacts.force_on_person
        self._contact_steps += (force > 0).any(axis=1) & ~self.faulted
        measured = {
            "distance": distance,
            "eaten": events.eaten,
            "spilled": events.spilled,
            "force_mouth": contacts.force_mouth.max(axis=1),
        }
        arm_force = np.maximum(force[:, -1] - contacts.force_spoon[:, -1], 0.0)
        return Scored(terms, measured, np.stack([arm_force, contacts.force_spoon[:, -1]], axis=1))

    def _feed(self, poses: Poses) -> rewards.FoodEvents:
        """Moves food from the spoon to the mouth or off the spoon; a faulted world's stays."""
        alive = ~self.faulted[:, None]
        where = foods.places(poses.spoon, poses.spoon_quaternion)
        eaten = foods.eaten_now(self.food, where, poses.mouth) & alive
        self.food[eaten] = Piece.EATEN
        last = poses.last()
        acceleration = (last.spoon_velocity - self._velocity) / self._task.control_period
        self._velocity = last.spoon_velocity
        angle = foods.tilt(last.spoon_quaternion, acceleration)
        spilled = foods.spilled_now(self.food, angle) & alive
        self.food[spilled] = Piece.SPILLED
        on_person = (spilled & self._task.below(where[:, -1])[1]).sum(axis=1)
        self._on_person += on_person
        return rewards.FoodEvents(eaten.sum(axis=1), spilled.sum(axis=1), on_person)

    def _see(
        self, poses: Poses, forces: Float[np.ndarray, "B f"]
    ) -> tuple[Float[np.ndarray, "B r"], Float[np.ndarray, "B h"]]:
        return observe(poses.last(), *self._angles(), forces, self._task.chest)

    def _helped(self) -> Bool[np.ndarray, " B"]:
        return np.asarray((self.food == Piece.EATEN).sum(axis=1) >= foods.ENOUGH)

    def _counts(self) -> dict[str, Int[np.ndarray, " B"]]:
        return {
            "eaten": (self.food == Piece.EATEN).sum(axis=1),
            "spilled": (self.food == Piece.SPILLED).sum(axis=1),
            "spilled_on_person": self._on_person.copy(),
            "contact_steps": self._contact_steps.copy(),
        }

    def _shown(self) -> list[np.ndarray]:
        return [self.food]

"""B itch-scratching episodes: what is drawn, what is counted, what is seen."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.tasks.bodies import human
from rigid.tasks.itch_scratching import reward as rewards
from rigid.tasks.itch_scratching.observation import observe
from rigid.tasks.itch_scratching.scene import LIMBS
from rigid.tasks.itch_scratching.sensing import Contacts, Poses, Sensors
from rigid.tasks.physics.world import DrivenWorld, Scored

if TYPE_CHECKING:
    from rigid.tasks.itch_scratching.task import ItchScratching


class ItchScratchingWorld(DrivenWorld["ItchScratching", Contacts, Poses]):
    """Steps B episodes; see `rigid.tasks.protocol.World`.

    A snapshot ends with the itch and the contacts counted so far; where itches are spread, how far
    below the middle of its limb [m] comes before them.
    """

    forces_seen = 3

    def __init__(self, task: ItchScratching, batch: int, threads: int) -> None:
        self._sensors = Sensors(task.model)
        super().__init__(task, batch, threads)

    @cached_property
    def _half_lengths(self) -> Float[np.ndarray, "2"]:
        """The middle of a limb lies half its length below the joint that it hangs from [m]."""
        return np.array([-self._task.model.site(f"itch_{limb}").pos[2] for limb in LIMBS])

    def _clear(self) -> None:
        self._start[:, self._person] = human.start_angles()
        self.itch = np.zeros(self.batch, dtype=np.int64)
        self._shift = np.zeros((self.batch, len(LIMBS))) if self._parameters.itch_spread else None
        self._last_counted = np.zeros((self.batch, 3))
        self.counted = np.zeros(self.batch, dtype=np.int64)
        self.contact_steps = np.zeros(self.batch, dtype=np.int64)

    def _draw(self, world: int, rng: np.random.Generator) -> None:
        limbs, spread = self._parameters.itch_limbs, self._parameters.itch_spread
        self._draw_robot(world, rng)
        self.itch[world] = LIMBS.index(limbs[rng.integers(len(limbs))])
        self._draw_tremor(world, rng)
        if self._shift is not None:  # Last, so that the rest starts alike at any spread.
            self._shift[world] = rng.uniform(-spread, spread) * self._half_lengths

    def _contacts(self, data: Float[np.ndarray, "B S n"]) -> Contacts:
        return self._sensors.contacts(data, self.itch, self._shift)

    def _poses(self, data: Float[np.ndarray, "B S n"]) -> Poses:
        return self._sensors.poses(data[:, -1], self._shift)

    def _itch_of(self, poses: Poses) -> Float[np.ndarray, "B 3"]:
        itch: np.ndarray = poses.itches[np.arange(self.batch), self.itch]
        return itch

    def _score(self, action: Float[np.ndarray, "B a"], contacts: Contacts, poses: Poses) -> Scored:
        distance = np.linalg.norm(poses.tip - self._itch_of(poses), axis=1)
        counted = rewards.counted_contacts(contacts, self._last_counted)
        self._last_counted = np.where(counted[:, None], contacts.itch_contact, self._last_counted)
        self.counted += counted & ~self.faulted
        self.contact_steps += contacts.itch_touched & ~self.faulted
        terms = rewards.reward_terms(
            self._parameters.weights,
            distance=distance,
            counted=counted,
            action=action,
            end_effector_speed=poses.end_effector_speed,
            contacts=contacts,
        )
        measured = {
            "distance": distance,
            "counted": counted,
            "force_itch": contacts.force_itch.max(axis=1),
        }
        on_person, at_itch = contacts.force_on_person[:, -1], contacts.force_itch[:, -1]
        return Scored(terms, measured, np.stack([contacts.tool_force, on_person, at_itch], axis=1))

    def _see(
        self, poses: Poses, forces: Float[np.ndarray, "B f"]
    ) -> tuple[Float[np.ndarray, "B r"], Float[np.ndarray, "B h"]]:
        itch, task = self._itch_of(poses), self._task
        return observe(
            poses, itch, *self._angles(), forces, task.chest, itch_visible=task.itch_visible
        )

    def _wanted(self) -> list[Float[np.ndarray, "B k"]]:
        return [np.eye(len(LIMBS))[self.itch]]

    def _helped(self) -> Bool[np.ndarray, " B"]:
        return np.asarray(self.counted >= rewards.SUCCESS_CONTACTS)

    def _counts(self) -> dict[str, Int[np.ndarray, " B"]]:
        return {
            "counted_contacts": self.counted.copy(), "contact_steps": self.contact_steps.copy(),
        }  # fmt: skip

    def _shown(self) -> list[np.ndarray]:
        columns = [self.itch[:, None], self.counted[:, None]]
        if self._shift is None:
            return columns
        return [self._shift[np.arange(self.batch), self.itch][:, None], *columns]

"""From MuJoCo's flat sensor array to named quantities; indices are resolved by name at load."""

from __future__ import annotations

from typing import NamedTuple

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from rigid.tasks.bodies import head
from rigid.tasks.feeding.scene import PARTS, SPOON_CONTACTS
from rigid.tasks.physics.sensing import (
    all_but,
    normal_columns,
    person_columns,
    sensor_columns,
    sensor_start,
)

LIPS = 0.05
"""The spoon may touch the head within this distance of the mouth [m]; any other contact of robot
and person is unwanted. Ours: the opening of the mouth and its lips lie within 4.5 cm."""


class Contacts(NamedTuple):
    """Contacts of one control step; forces are sums of normal components [N]."""

    force_on_person: Float[np.ndarray, "B S"]
    """Robot or spoon on the person, at each of S physics steps."""
    force_spoon: Float[np.ndarray, "B S"]
    """The spoon's part of it."""
    force_mouth: Float[np.ndarray, "B S"]
    """The part of the spoon's within `LIPS` of the mouth."""
    force_unwanted: Float[np.ndarray, "B S"]
    """All but that."""
    touched_unwanted: Bool[np.ndarray, " B"]


class Poses(NamedTuple):
    """Where things are at the start of physics steps, world frame [m]; *B is B or B S."""

    spoon: Float[np.ndarray, "*B 3"]
    spoon_quaternion: Float[np.ndarray, "*B 4"]
    spoon_velocity: Float[np.ndarray, "*B 3"]
    """[m/s]"""
    end_effector_speed: Float[np.ndarray, "*B"]
    mouth: Float[np.ndarray, "*B 3"]
    head: Float[np.ndarray, "*B 3"]
    """The joint on which the head turns."""
    head_quaternion: Float[np.ndarray, "*B 4"]

    def last(self) -> Poses:
        """Those of the last physics step of each world."""
        return Poses(*(field[:, -1] for field in self))


class Sensors:
    """Slices of `sensordata` for one model."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._person = person_columns(model, PARTS)
        others = [part for part in PARTS if part != head.HEAD_BODY]
        self._spoon = np.stack(
            [normal_columns(model, f"spoon_{part}", SPOON_CONTACTS) for part in others]
        )
        # Of each contact of spoon and head: the force's three components, then the place.
        begin = sensor_start(model, f"spoon_{head.HEAD_BODY}")
        self._on_head = begin + 6 * np.arange(SPOON_CONTACTS)
        self._poses = {
            name: sensor_columns(model, name)
            for name in (
                "spoon_position", "spoon_rotation", "spoon_velocity", "end_effector_velocity",
                "mouth_position", "head_position", "head_rotation",
            )
        }  # fmt: skip

    def poses(self, data: Float[np.ndarray, "*B n"]) -> Poses:
        """Reads poses from the sensors of one or more physics steps."""
        column = {name: data[..., where] for name, where in self._poses.items()}
        return Poses(
            spoon=column["spoon_position"],
            spoon_quaternion=column["spoon_rotation"],
            spoon_velocity=column["spoon_velocity"],
            end_effector_speed=np.linalg.norm(column["end_effector_velocity"], axis=-1),
            mouth=column["mouth_position"],
            head=column["head_position"],
            head_quaternion=column["head_rotation"],
        )

    def contacts(self, data: Float[np.ndarray, "B S n"]) -> Contacts:
        """Accumulates the contacts of all S physics steps of a control step.

        Args:
            data: `sensordata` after each physics step. MuJoCo's sensors describe the state before
                the step, so entry s holds the forces that acted during physics step s.
        """
        on_person = data[..., self._person].sum(axis=(-1, -2))
        on_head = data[..., self._on_head]
        place = data[..., self._on_head[:, None] + np.arange(3, 6)]
        mouth = data[..., self._poses["mouth_position"]]
        near = np.linalg.norm(place - mouth[..., None, :], axis=-1) < LIPS
        at_mouth = np.where(near, on_head, 0.0).sum(axis=-1)
        unwanted = all_but(on_person, at_mouth)
        return Contacts(
            force_on_person=on_person,
            force_spoon=data[..., self._spoon].sum(axis=(-1, -2)) + on_head.sum(axis=-1),
            force_mouth=at_mouth,
            force_unwanted=unwanted,
            touched_unwanted=np.any(unwanted > 0, axis=-1),
        )

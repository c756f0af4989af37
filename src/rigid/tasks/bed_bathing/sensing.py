"""From MuJoCo's flat sensor array to named quantities; indices are resolved by name at load."""

from __future__ import annotations

from typing import NamedTuple

import mujoco
import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from rigid.tasks.bed_bathing.points import LIMBS
from rigid.tasks.bed_bathing.scene import ARM, PAD_CONTACTS
from rigid.tasks.bodies import lying
from rigid.tasks.physics.sensing import (
    all_but,
    normal_columns,
    person_columns,
    sensor_columns,
    sensor_start,
)

_FIELDS = 7  # Of a contact of the pad: found, three components of the force, three of the place.


class Contacts(NamedTuple):
    """Contacts of one control step; forces are sums of normal components [N]."""

    force_on_person: Float[np.ndarray, "B S"]
    """Robot or wiper on the person, at each of S physics steps."""
    force_pad: Float[np.ndarray, "B S"]
    """The part of it that the pad has on the right arm."""
    force_unwanted: Float[np.ndarray, "B S"]
    """All but that."""
    touched_unwanted: Bool[np.ndarray, " B"]
    tool_force: Float[np.ndarray, " B"]
    """Wiper on anything at the last physics step."""
    touching: Bool[np.ndarray, "B S L C"]
    """Which contacts of the pad there are on each of `LIMBS`."""
    places: Float[np.ndarray, "B S L C 3"]
    """Where they are, in the frame of the limb [m]; 0 where there are none."""


class Poses(NamedTuple):
    """Where things are at the start of the last physics step, world frame [m]."""

    pad: Float[np.ndarray, "B 3"]
    pad_quaternion: Float[np.ndarray, "B 4"]
    end_effector_speed: Float[np.ndarray, " B"]
    arm: Float[np.ndarray, "B 3 3"]
    """Right shoulder, elbow and wrist."""
    distance: Float[np.ndarray, " B"]
    """Between pad and the nearest of `LIMBS`; 0 where they touch."""


class Sensors:
    """Slices of `sensordata` for one model."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._person = person_columns(model, lying.PARTS)
        starts = np.array([sensor_start(model, f"pad_{part}") for part in ARM])
        self._pad = starts[:, None] + _FIELDS * np.arange(PAD_CONTACTS)
        self._tool = normal_columns(model, "contact_tool")
        self._position, self._quaternion, self._velocity = (
            sensor_columns(model, name)
            for name in ("pad_position", "pad_rotation", "end_effector_velocity")
        )
        self._arm = np.stack([sensor_columns(model, f"{part}_position") for part in ARM])
        self._turned = np.stack([sensor_columns(model, f"right_{limb}_rotation") for limb in LIMBS])
        self._distance = np.array([sensor_start(model, f"pad_to_{limb}") for limb in LIMBS])

    def poses(self, data: Float[np.ndarray, "B n"]) -> Poses:
        """Reads poses from one physics step's sensors."""
        return Poses(
            pad=data[:, self._position],
            pad_quaternion=data[:, self._quaternion],
            end_effector_speed=np.linalg.norm(data[:, self._velocity], axis=1),
            arm=data[:, self._arm],
            distance=np.maximum(data[:, self._distance].min(axis=1), 0.0),
        )

    def contacts(self, data: Float[np.ndarray, "B S n"]) -> Contacts:
        """Accumulates the contacts of all S physics steps of a control step.

        Args:
            data: `sensordata` after each physics step. MuJoCo's sensors describe the state before
                the step, so entry s holds the forces that acted during physics step s.
        """
        on_person = data[..., self._person].sum(axis=(-1, -2))
        pad = data[..., self._pad + 1].sum(axis=(-1, -2))
        unwanted = all_but(on_person, pad)
        touching = data[..., self._pad[: len(LIMBS)]] > 0
        return Contacts(
            force_on_person=on_person,
            force_pad=pad,
            force_unwanted=unwanted,
            touched_unwanted=np.any(unwanted > 0, axis=-1),
            tool_force=data[:, -1, self._tool].sum(axis=-1),
            touching=touching,
            places=self._on_limbs(data, touching),
        )

    def _on_limbs(
        self, data: Float[np.ndarray, "B S n"], touching: Bool[np.ndarray, "B S L C"]
    ) -> Float[np.ndarray, "B S L C 3"]:
        """Places of the contacts that there are, in the frames of their limbs."""
        places = np.zeros((*touching.shape, 3))
        world, step, limb, contact = np.nonzero(touching)
        if len(world):
            row = data[world, step]
            columns = self._pad[limb, contact][:, None] + np.arange(4, _FIELDS)
            at, origin, turned = (
                np.take_along_axis(row, which, axis=1)
                for which in (columns, self._arm[limb], self._turned[limb])
            )
            inverse = Rotation.from_quat(turned, scalar_first=True).inv()
            places[world, step, limb, contact] = inverse.apply(at - origin)
        return places

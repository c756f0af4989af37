"""From MuJoCo's flat sensor array to named quantities; indices are resolved by name at load."""

from __future__ import annotations

from typing import NamedTuple

import mujoco
import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.tasks.bodies import human, scratcher
from rigid.tasks.itch_scratching.scene import LIMBS
from rigid.tasks.physics.sensing import normal_columns, person_columns, sensor_start
from rigid.tasks.physics.sensing import sensor_columns as _columns

SCRATCH_RADIUS = 0.025
"""A contact counts within this distance of the itch [m] (Assistive Gym)."""
_ARM_LANDMARKS = ("right_shoulder_joint", "right_elbow", "right_wrist")
_LIMB_ENDS = {"upper_arm": (0, 1), "forearm": (1, 2)}
"""Landmarks at the upper and the lower end of each limb."""


class Contacts(NamedTuple):
    """Contacts of one control step; forces are sums of normal components [N]."""

    force_on_person: Float[np.ndarray, "B S"]
    """Robot or tool on the person, at each of S physics steps."""
    force_unwanted: Float[np.ndarray, "B S"]
    """The part of it outside the arms."""
    touched_unwanted: Bool[np.ndarray, " B"]
    force_itch: Float[np.ndarray, "B S"]
    """Tip and rod on the itching limb within `SCRATCH_RADIUS` of the itch."""
    itch_touched: Bool[np.ndarray, " B"]
    itch_contact: Float[np.ndarray, "B 3"]
    """Where the last such contact was [m], world frame; undefined where none was."""
    tool_force: Float[np.ndarray, " B"]
    """Tool on anything at the last physics step."""


class Poses(NamedTuple):
    """Where things are at the start of the last physics step, world frame [m]."""

    tip: Float[np.ndarray, "B 3"]
    tip_quaternion: Float[np.ndarray, "B 4"]
    end_effector_speed: Float[np.ndarray, " B"]
    itches: Float[np.ndarray, "B 2 3"]
    """Both itch points, in the order of `LIMBS`."""
    arm: Float[np.ndarray, "B 3 3"]
    """Right shoulder, elbow and wrist."""


class Sensors:
    """Slices of `sensordata` for one model."""

    def __init__(self, model: mujoco.MjModel) -> None:
        parts = human.ARM_PARTS + human.TRUNK_PARTS
        self._person = person_columns(model, parts)
        self._trunk = slice(len(human.ARM_PARTS), len(parts))
        geoms = (scratcher.TIP_GEOM, scratcher.ROD_GEOM)
        self._scratch = np.array(
            [[sensor_start(model, f"{geom}_{limb}") for geom in geoms] for limb in LIMBS]
        )
        self._tool = normal_columns(model, "contact_tool")
        self._tip = _columns(model, "tip_position")
        self._tip_quaternion = _columns(model, "tip_rotation")
        self._velocity = _columns(model, "end_effector_velocity")
        self._itches = np.stack([_columns(model, f"itch_{limb}") for limb in LIMBS])
        self._arm = np.stack([_columns(model, name) for name in _ARM_LANDMARKS])

    def poses(
        self, data: Float[np.ndarray, "B n"], shift: Float[np.ndarray, "B 2"] | None = None
    ) -> Poses:
        """Reads poses from one physics step's sensors; `shift` as in `contacts`."""
        itches = data[:, self._itches]
        if shift is not None:
            itches = itches + shift[:, :, None] * self._along(data)
        return Poses(
            tip=data[:, self._tip],
            tip_quaternion=data[:, self._tip_quaternion],
            end_effector_speed=np.linalg.norm(data[:, self._velocity], axis=1),
            itches=itches,
            arm=data[:, self._arm],
        )

    def contacts(
        self,
        data: Float[np.ndarray, "B S n"],
        itch: Int[np.ndarray, " B"],
        shift: Float[np.ndarray, "B 2"] | None = None,
    ) -> Contacts:
        """Accumulates the contacts of all S physics steps of a control step.

        Args:
            data: `sensordata` after each physics step. MuJoCo's sensors describe the state before
                the step, so entry s holds the forces that acted during physics step s.
            itch: The limb that itches, index into `LIMBS`.
            shift: How far the itch of either limb lies below its middle [m], in the order of
                `LIMBS`; None: in the middle.
        """
        batch = np.arange(len(data))
        normals = data[:, :, self._person]  # [B, S, parts, contacts]
        by_part = normals.sum(axis=-1)
        unwanted = by_part[:, :, self._trunk].sum(axis=-1)
        # [B, S, geoms] of the itching limb: found, normal force, position.
        columns = self._scratch[itch][:, None, :]
        rows, steps = batch[:, None, None], np.arange(data.shape[1])[None, :, None]
        found = data[rows, steps, columns] > 0
        force = data[rows, steps, columns + 1]
        place = data[rows[..., None], steps[..., None], columns[..., None] + np.arange(4, 7)]
        itch_place = data[rows[..., None], steps[..., None], self._itches[itch][:, None, None, :]]
        if shift is not None:
            along = self._along(data)[batch, :, itch][:, :, None, :]
            itch_place = itch_place + shift[batch, itch][:, None, None, None] * along
        near = found & (np.linalg.norm(place - itch_place, axis=-1) < SCRATCH_RADIUS)
        flat = near.reshape(len(data), -1)
        last = flat.shape[1] - 1 - np.argmax(flat[:, ::-1], axis=1)
        return Contacts(
            force_on_person=by_part.sum(axis=-1),
            force_unwanted=unwanted,
            touched_unwanted=(unwanted > 0).any(axis=1),
            force_itch=np.where(near, force, 0.0).sum(axis=-1),
            itch_touched=flat.any(axis=1),
            itch_contact=place.reshape(len(data), -1, 3)[batch, last],
            tool_force=data[:, -1, self._tool].sum(axis=-1),
        )

    def _along(self, data: Float[np.ndarray, "*B n"]) -> Float[np.ndarray, "*B 2 3"]:
        """Unit vector down each limb, in the order of `LIMBS`, from the landmarks at its ends."""
        arm = data[..., self._arm]
        upper, lower = np.array([_LIMB_ENDS[limb] for limb in LIMBS]).T
        limbs = arm[..., lower, :] - arm[..., upper, :]
        along: np.ndarray = limbs / np.linalg.norm(limbs, axis=-1, keepdims=True)
        return along

"""Where a scene's sensors stand in MuJoCo's flat array; resolved by name as a scene is loaded."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol, runtime_checkable

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from rigid.tasks.physics.scene import CONTACTS_PER_PART, PENETRATION


@runtime_checkable
class PersonContacts(Protocol):
    """What every task tells of the contacts of a control step; forces are sums of normals [N]."""

    @property
    def force_on_person(self) -> Float[np.ndarray, "B S"]:
        """Robot or tool on the person, at each of S physics steps."""
        ...

    @property
    def force_unwanted(self) -> Float[np.ndarray, "B S"]:
        """The part of it where the robot should not touch."""
        ...

    @property
    def touched_unwanted(self) -> Bool[np.ndarray, " B"]:
        """Whether there was any such force."""
        ...


def all_but(
    on_person: Float[np.ndarray, "*B"], wanted: Float[np.ndarray, "*B"]
) -> Float[np.ndarray, "*B"]:
    """The part of a force that is unwanted; less than rounding of the two sums is no contact."""
    unwanted: np.ndarray = np.where(on_person > wanted + 1e-9, on_person - wanted, 0.0)
    return unwanted


def sensor_start(model: mujoco.MjModel, name: str) -> int:
    """First column of a sensor in `sensordata`."""
    return int(model.sensor(name).adr[0])


def sensor_columns(model: mujoco.MjModel, name: str) -> np.ndarray:
    """Every column of a sensor."""
    sensor = model.sensor(name)
    columns: np.ndarray = sensor.adr[0] + np.arange(sensor.dim[0])
    return columns


def normal_columns(model: mujoco.MjModel, name: str, count: int = CONTACTS_PER_PART) -> np.ndarray:
    """Columns of the normal component of each contact kept by a force-only sensor."""
    columns: np.ndarray = sensor_start(model, name) + 3 * np.arange(count)
    return columns


def person_columns(model: mujoco.MjModel, parts: Sequence[str]) -> np.ndarray:
    """Normal forces that `add_person_sensors` sees, shape (parts, contacts)."""
    return np.stack([normal_columns(model, f"contact_{part}") for part in parts])


def penetration_reader(
    model: mujoco.MjModel,
) -> Callable[[Float[np.ndarray, "B S n"]], Float[np.ndarray, " B"]]:
    """Returns what reads the deepest overlap [m] of each world's control step.

    Overlaps are those that `add_penetration_sensors` sees.
    """
    names = (model.sensor(index).name for index in range(model.nsensor))
    found = [sensor_start(model, name) for name in names if name.startswith(PENETRATION)]
    columns = np.array(found)

    def penetration(data: Float[np.ndarray, "B S n"]) -> Float[np.ndarray, " B"]:
        depth: np.ndarray = -data[:, :, columns].min(axis=(1, 2))
        return depth

    return penetration

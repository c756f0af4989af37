"""The scene: who sits and stands where, and the sensors that observe contacts and poses."""

from __future__ import annotations

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from rigid.tasks.bodies import head, human, jaco, spoon, table, wheelchair
from rigid.tasks.feeding.food import PIECES, RADIUS
from rigid.tasks.feeding.parameters import FeedingParameters
from rigid.tasks.physics.scene import (
    FORCE,
    POS,
    add_contact_sensor,
    add_frame_sensors,
    add_penetration_sensors,
    add_person_sensors,
    floating_spec,
    soften,
)

RATE = 1.25
"""Of every servo [1/s]: Assistive Gym's motor gain of this task (0.025) over its time step, half of
that of itch scratching."""
PARTS = (*human.RESTING_PARTS, *head.HEAD_PARTS)
"""Bodies of the person."""
SPOON_CONTACTS = 4
"""Contacts of the spoon kept for each part of the person. Ours."""
_FOOD = (1.0, 0.62, 0.10, 1.0)
_CELL = 0.02  # [m], ours: of the map of what lies below.
_MAP_FROM, _MAP_TO = np.array([-1.3, -1.3]), np.array([0.7, 0.7])
"""[m], x and y: where the robot reaches."""


def build_spec(parameters: FeedingParameters) -> mujoco.MjSpec:
    """Assembles wheelchair, table, person, arm and spoon, with their sensors."""
    spec = floating_spec("feeding", parameters.physics_step)
    _add_surroundings(spec, parameters)
    head.add_moving_head(
        spec, parameters.body_size,
        servo=jaco.Servo(1.7, 0.03, (parameters.strength,) * len(head.HEAD_JOINTS), RATE),
        limit_scale=parameters.limit_scale,
    )  # fmt: skip
    hand = jaco.add_jaco(
        spec,
        position=wheelchair.JACO_MOUNT,
        yaw=wheelchair.JACO_YAW,
        servo=jaco.robot_servo(parameters.servo, RATE),
    )
    spoon.add_spoon(hand)
    soften(spec)
    add_person_sensors(spec, PARTS)
    held = (mujoco.mjtObj.mjOBJ_BODY, spoon.SPOON_BODY)
    for part in PARTS:
        fields = FORCE | POS if part == head.HEAD_BODY else FORCE
        add_contact_sensor(
            spec, f"spoon_{part}", held, (mujoco.mjtObj.mjOBJ_BODY, part),
            fields=fields, count=SPOON_CONTACTS,
        )  # fmt: skip
    add_penetration_sensors(spec, (jaco.BASE_BODY, "neck"))
    sensors = (
        ("spoon_position", "position", spoon.SPOON_SITE),
        ("spoon_rotation", "rotation", spoon.SPOON_SITE),
        ("spoon_velocity", "velocity", spoon.SPOON_SITE),
        ("end_effector_velocity", "velocity", jaco.END_EFFECTOR_SITE),
        ("mouth_position", "position", head.MOUTH_SITE),
        ("head_position", "position", head.HEAD_BODY),
        ("head_rotation", "rotation", head.HEAD_BODY),
    )
    add_frame_sensors(spec, sensors)
    return spec


def _add_surroundings(spec: mujoco.MjSpec, parameters: FeedingParameters) -> None:
    """All that never moves."""
    wheelchair.add_wheelchair(spec)
    table.add_table(spec)
    human.add_resting_body(spec, parameters.body_size)


def food_body(index: int) -> str:
    """Name of the body of one piece, in the scene that is drawn."""
    return f"spoon_food_{index}"


def add_food(spec: mujoco.MjSpec) -> None:
    """Puts food to look at on the spoon, a body for each piece, and marks the spoon's tip."""
    carrier = spec.body(spoon.SPOON_BODY)
    carrier.add_geom(
        name="spoon_tip", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=(0.002, 0, 0),
        pos=spoon.TIP, mass=0.0, rgba=spoon.RGBA, contype=0, conaffinity=0,
    )  # fmt: skip
    for index, place in enumerate(PIECES):
        piece = carrier.add_body(name=food_body(index), pos=place)
        piece.add_geom(
            name=food_body(index), type=mujoco.mjtGeom.mjGEOM_SPHERE, size=(RADIUS, 0, 0),
            mass=0.0, rgba=_FOOD, contype=0, conaffinity=0,
        )  # fmt: skip


class Below:
    """What lies below any place: how high, and whether it is the person.

    Read from a map of what never moves, without the head.
    """

    def __init__(self, parameters: FeedingParameters) -> None:
        spec = mujoco.MjSpec()
        spec.compiler.degree = False
        _add_surroundings(spec, parameters)
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        strangers = {model.body(name).id for name in ("wheelchair", "table")}
        self._shape = np.ceil((_MAP_TO - _MAP_FROM) / _CELL).astype(int)
        self._height, self._person = np.zeros(self._shape), np.zeros(self._shape, dtype=bool)
        hit = np.zeros(1, dtype=np.int32)
        for cell in np.ndindex(*self._shape):
            x, y = _MAP_FROM + (np.array(cell) + 0.5) * _CELL
            start = np.array([x, y, 3.0])
            far = mujoco.mj_ray(model, data, start, np.array([0, 0, -1.0]), None, 1, -1, hit)
            if far >= 0:
                self._height[cell] = start[2] - far
                self._person[cell] = model.geom_bodyid[hit[0]] not in strangers

    def __call__(
        self, places: Float[np.ndarray, "*B 3"]
    ) -> tuple[Float[np.ndarray, "*B"], Bool[np.ndarray, "*B"]]:
        """Height [m] of what lies below, 0 where there is nothing, and whether it is the person."""
        cells = np.floor((places[..., :2] - _MAP_FROM) / _CELL).astype(int)
        inside = ((cells >= 0) & (cells < self._shape)).all(axis=-1)
        x, y = np.moveaxis(np.clip(cells, 0, self._shape - 1), -1, 0)
        return np.where(inside, self._height[x, y], 0.0), inside & self._person[x, y]

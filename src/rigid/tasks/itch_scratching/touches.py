"""Who touches whom in an episode: the contacts of robot and person that the report shows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from rigid.tasks.bodies import human, jaco
from rigid.tasks.itch_scratching.scene import LIMBS

_KINDS = {"itch": 0, "arm": 1, "unwanted": 2}


class _Sides(NamedTuple):
    """Bodies by what a contact with them means."""

    robot: int
    """Root of the robot's arm."""
    trunk: frozenset[int]
    person: frozenset[int]
    """The trunk's and the arms'."""
    limb: int
    """The one that itches."""


class _Touch(NamedTuple):
    place: tuple[float, ...]
    force: float
    kind: str
    robot: int
    person: int

    def mark(self, frame: int) -> list[float]:
        """As `rigid.report.payload.Replay` has it."""
        place = [round(x, 4) for x in self.place]
        return [frame, *place, round(self.force, 2), _KINDS[self.kind], self.robot, self.person]


def contact_marks(
    model: mujoco.MjModel,
    snapshots: Float[np.ndarray, "T1 state"],
    unwanted: Bool[np.ndarray, " T"],
    count: int,
) -> list[list[float]]:
    """Where robot and person touch at the end of each step, and hits that are over by then.

    Args:
        model: The scene with the fine physics step of the replay.
        snapshots: `World.snapshot` after the reset and after each step.
        unwanted: Steps with force outside the arms at some physics step. Where the end of such a
            step shows no unwanted contact, the hardest one within it is marked.
        count: Physics steps of a control step.

    Returns:
        Rows of frame, place x, y, z [m], normal force [N], kind (0 on the itching limb, 1 elsewhere
        on the arms, 2 unwanted), and the bodies of robot and person, indices into the scene's.
    """
    data, sides = mujoco.MjData(model), _sides(model, int(snapshots[0, -2]))
    marks = []
    for frame in range(1, len(snapshots)):
        _put(model, data, snapshots[frame], snapshots[frame])
        mujoco.mj_forward(model, data)
        touches = list(_touches(model, data, sides))
        if unwanted[frame - 1] and not any(touch.kind == "unwanted" for touch in touches):
            _put(model, data, snapshots[frame - 1], snapshots[frame])
            touches += _hardest_unwanted(model, data, sides, count)
        marks += [touch.mark(frame) for touch in touches]
    return marks


def _sides(model: mujoco.MjModel, itch: int) -> _Sides:
    def ids(names: tuple[str, ...]) -> frozenset[int]:
        return frozenset(int(model.body(name).id) for name in names)

    trunk = ids(human.TRUNK_PARTS)
    return _Sides(
        robot=int(model.body(jaco.BASE_BODY).id),
        trunk=trunk,
        person=trunk | ids(human.ARM_PARTS),
        limb=int(model.body(f"right_{LIMBS[itch]}").id),
    )


def _put(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    state: Float[np.ndarray, " state"],
    driven: Float[np.ndarray, " state"],
) -> None:
    """Angles and speeds of one snapshot, targets of another; nothing else stays."""
    size = model.nq
    mujoco.mj_resetData(model, data)
    data.qpos[:], data.qvel[:] = state[:size], state[size : 2 * size]
    data.ctrl[:] = driven[2 * size : 3 * size]


def _touches(model: mujoco.MjModel, data: mujoco.MjData, sides: _Sides) -> Iterator[_Touch]:
    """Contacts of robot and person, with the forces of the last forward pass."""
    force = np.zeros(6)
    for index, contact in enumerate(data.contact):
        bodies = [int(body) for body in model.geom_bodyid[list(contact.geom)]]
        person = next((body for body in bodies if body in sides.person), None)
        robot = next((b for b in bodies if model.body_rootid[b] == sides.robot), None)
        if person is None or robot is None:
            continue
        mujoco.mj_contactForce(model, data, index, force)
        on_arms = "itch" if person == sides.limb else "arm"
        kind = "unwanted" if person in sides.trunk else on_arms
        place = tuple(float(x) for x in contact.pos)
        yield _Touch(place, float(force[0]), kind, robot, person)


def _hardest_unwanted(
    model: mujoco.MjModel, data: mujoco.MjData, sides: _Sides, count: int
) -> list[_Touch]:
    """The hardest unwanted contact of the next `count` physics steps; none where there is none."""
    hits: list[_Touch] = []
    for _ in range(count):
        mujoco.mj_step(model, data)
        hits += [hit for hit in _touches(model, data, sides) if hit.kind == "unwanted"]
    return [max(hits, key=lambda hit: hit.force)] if hits else []

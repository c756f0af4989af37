"""Who touches whom in an episode: the contacts of robot and person that the report shows."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import Final, NamedTuple

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from rigid.tasks.bodies import jaco

AT_TARGET: Final = 0
ALLOWED: Final = 1
UNWANTED: Final = 2
"""Kinds of contact (`rigid.report.payload.Replay`)."""

Kind = Callable[[mujoco.MjData, "Touch"], int]
"""What a contact means, in the state that has it."""


class Touch(NamedTuple):
    """A contact of robot and person."""

    place: tuple[float, ...]
    """World frame [m]."""
    force: float
    """Normal component [N]."""
    robot: int
    """Body of the robot or its tool."""
    person: int
    """Body of the person."""


class TouchFinder:
    """Finds the contacts of robot and person in one scene."""

    def __init__(self, model: mujoco.MjModel, person: Collection[str], kind: Kind) -> None:
        """Resolves the names.

        Args:
            model: The scene with the fine physics step of the replay.
            person: Bodies of the person.
            kind: What a contact means.
        """
        self._model, self._data, self._kind = model, mujoco.MjData(model), kind
        self._robot = int(model.body(jaco.BASE_BODY).id)
        self._person = frozenset(int(model.body(name).id) for name in person)

    def marks(
        self, snapshots: Float[np.ndarray, "T1 state"], unwanted: Bool[np.ndarray, " T"], count: int
    ) -> list[list[float]]:
        """Where robot and person touch at the end of each step, and hits that are over by then.

        Args:
            snapshots: Of the world, after the reset and after each step: angles, velocities and
                targets come first.
            unwanted: Steps with unwanted force at some physics step. Where the end of such a step
                shows no unwanted contact, the hardest one within it is marked.
            count: Physics steps of a control step.

        Returns:
            Rows of frame, place x, y, z [m], normal force [N], kind, and the bodies of robot and
            person, indices into the scene's.
        """
        found = []
        for frame in range(1, len(snapshots)):
            self._put(snapshots[frame], snapshots[frame])
            mujoco.mj_forward(self._model, self._data)
            touches = list(self._touches())
            if unwanted[frame - 1] and not any(kind == UNWANTED for kind, _ in touches):
                self._put(snapshots[frame - 1], snapshots[frame])
                touches += self._hardest_unwanted(count)
            found += [_mark(frame, kind, touch) for kind, touch in touches]
        return found

    def _put(self, state: Float[np.ndarray, " state"], driven: Float[np.ndarray, " state"]) -> None:
        """Angles and speeds of one snapshot, targets of another; nothing else stays."""
        size, data = self._model.nq, self._data
        mujoco.mj_resetData(self._model, data)
        data.qpos[:], data.qvel[:] = state[:size], state[size : 2 * size]
        data.ctrl[:] = driven[2 * size : 3 * size]

    def _touches(self) -> Iterator[tuple[int, Touch]]:
        """Contacts and their kinds, with the forces of the last forward pass."""
        model, data, force = self._model, self._data, np.zeros(6)
        for index, contact in enumerate(data.contact):
            bodies = [int(body) for body in model.geom_bodyid[list(contact.geom)]]
            person = next((body for body in bodies if body in self._person), None)
            robot = next((b for b in bodies if model.body_rootid[b] == self._robot), None)
            if person is None or robot is None:
                continue
            mujoco.mj_contactForce(model, data, index, force)
            place = tuple(float(x) for x in contact.pos)
            touch = Touch(place, float(force[0]), robot, person)
            yield self._kind(data, touch), touch

    def _hardest_unwanted(self, count: int) -> list[tuple[int, Touch]]:
        """The hardest unwanted contact of the next physics steps; none where there is none."""
        hits: list[tuple[int, Touch]] = []
        for _ in range(count):
            mujoco.mj_step(self._model, self._data)
            hits += [hit for hit in self._touches() if hit[0] == UNWANTED]
        return [max(hits, key=lambda hit: hit[1].force)] if hits else []


def _mark(frame: int, kind: int, touch: Touch) -> list[float]:
    """As `rigid.report.payload.Replay` has it."""
    place = [round(x, 4) for x in touch.place]
    return [frame, *place, round(touch.force, 2), kind, touch.robot, touch.person]

"""An episode as numbers: where tool, itch and robot were, and who touched whom.

Everything comes from the report's payload (`rigid.report.payload`), so that any task which fills it
can be asked what went wrong.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from rigid.report.motion import read_motion, tip_of

_NEEDED = (
    "bodies", "frames", "poses", "dt", "itch", "distance", "contacts", "force_unwanted", "outcome",
)  # fmt: skip
ANCHORED = 0.01
"""A robot's body that never leaves a ball of this size is its shoulder or below [m]. Ours: Jaco's
second link, which turns about two axes that all but meet, moves by 3 mm."""
_UNWANTED = 2
_UNKNOWN = -1


class Arm(NamedTuple):
    """How far a robot reaches, whatever its joints allow: an upper bound."""

    shoulder: Float[np.ndarray, "3"]
    """Where the arm is held, world frame [m]."""
    length: float
    """From there to the tool's tip, stretched [m]."""


@dataclass(frozen=True)
class Contacts:
    """Contacts of robot and person, one a row."""

    frame: Int[np.ndarray, " n"]
    place: Float[np.ndarray, "n 3"]
    """World frame [m]."""
    force: Float[np.ndarray, " n"]
    """Normal component [N]."""
    unwanted: Bool[np.ndarray, " n"]
    """Where nothing should touch; the others are on the arms."""
    robot: Int[np.ndarray, " n"]
    person: Int[np.ndarray, " n"]
    """Bodies of the scene; -1 where the replay does not tell."""


@dataclass(frozen=True)
class Episode:
    """One episode of F frames, world frame."""

    bodies: Sequence[str]
    dt: float
    """Between frames [s]."""
    outcome: str
    tip: Float[np.ndarray, "F 3"]
    """[m]"""
    itch: Float[np.ndarray, "F 3"]
    """[m]"""
    itching: int
    """The body that itches."""
    chain: Float[np.ndarray, "F n 3"]
    """Origins of the robot's bodies from its base on, then the tip [m]."""
    distance: Float[np.ndarray, " F"]
    """Tip to itch [m]."""
    counted: Float[np.ndarray, " F"] | None
    """Counted contacts so far; None in a task that counts none."""
    spilled: Float[np.ndarray, " F"] | None
    """Pieces of food that have fallen so far; None in a task without food."""
    goal: str
    """What the tool is to reach, in a word: where `itch` is."""
    force_unwanted: Float[np.ndarray, " F"]
    """Largest force where nothing should touch, in the step that ends at each frame [N]."""
    contacts: Contacts

    @property
    def frames(self) -> int:
        """F."""
        return len(self.tip)

    def name(self, body: int) -> str | None:
        """A body's name in plain words; None for one that is not known."""
        known = 0 <= body < len(self.bodies)
        return self.bodies[body].replace("_", " ") if known else None


def read_episode(scene: Mapping[str, Any] | None, replay: Mapping[str, Any]) -> Episode | None:
    """The episode of a replay; None where the scene or the replay tells too little.

    Args:
        scene: `rigid.report.payload.Scene`.
        replay: `rigid.report.payload.Replay`, its poses packed or an array.

    Raises:
        ValueError: The poses do not fit the scene.
    """
    tip = None if scene is None else tip_of(scene)
    if scene is None or tip is None or any(replay.get(name) is None for name in _NEEDED):
        return None
    robot = _robot(scene)
    motion = read_motion(scene, replay)
    if motion.itch is None or not robot:
        return None
    path = motion.path(tip)
    return Episode(
        bodies=scene["bodies"],
        dt=motion.dt,
        outcome=str(replay["outcome"]),
        tip=path,
        itch=motion.path(motion.itch),
        itching=motion.itch.body,
        chain=np.concatenate([motion.poses[:, robot, :3], path[:, None]], axis=1),
        distance=np.array(replay["distance"], float),
        counted=_counts(replay, "counted"),
        spilled=_counts(replay, "spilled"),
        goal=goal_of(scene),
        force_unwanted=motion.force_unwanted,
        contacts=_contacts(replay["contacts"]),
    )


def arm_of(episodes: Sequence[Episode]) -> Arm | None:
    """The robot's arm, as some episodes from the same start show it.

    The shoulder is the last body of the chain that none of them moves, counted from the base.
    None where the base moves, or where nothing does, since the arm is then unknown.
    """
    chain = np.concatenate([episode.chain for episode in episodes])
    moved = np.ptp(chain, axis=0).max(axis=-1) > ANCHORED
    if moved[0] or not moved[-1]:
        return None
    shoulder = int(np.argmax(moved)) - 1
    links = np.linalg.norm(np.diff(chain[0, shoulder:], axis=0), axis=-1)
    return Arm(chain[:, shoulder].mean(axis=0), float(links.sum()))


def goal_of(scene: Mapping[str, Any] | None) -> str:
    """What the tool is to reach in a scene, in a word for readers."""
    return "itch" if scene is None else str(scene.get("goal", "itch"))


def _counts(replay: Mapping[str, Any], name: str) -> Float[np.ndarray, " F"] | None:
    return None if replay.get(name) is None else np.array(replay[name], float)


def _robot(scene: Mapping[str, Any]) -> list[int]:
    """Bodies of robot and tool, in the scene's order: that of the chain."""
    return sorted({int(g["body"]) for g in scene["geoms"] if g["role"] in {"robot", "tool"}})


def _contacts(marks: Sequence[Sequence[float]]) -> Contacts:
    rows = [[*mark, _UNKNOWN, _UNKNOWN][:8] for mark in marks]
    table = np.array(rows, float).reshape(-1, 8)
    whole = table[:, [0, 5, 6, 7]].astype(int)
    return Contacts(
        frame=whole[:, 0],
        place=table[:, 1:4],
        force=table[:, 4],
        unwanted=whole[:, 1] == _UNWANTED,
        robot=whole[:, 2],
        person=whole[:, 3],
    )

"""What a study keeps of its participants: the shapes that server, export and analysis share.

Everything here is pseudonymous at most: motion can identify people (`docs/study.md`).
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Literal

import numpy as np
from jaxtyping import Bool, Float

from rigid.files import json_text

Device = Literal["mouse", "keyboard", "touch", "xr-controller", "xr-hand", "scripted"]
"""How the hand was moved. A referee can tell a device from a policy, so devices are kept apart."""
DeviceClass = Literal["desktop", "touch", "vr", "scripted"]
DEVICE_CLASSES: Mapping[Device, DeviceClass] = {
    "mouse": "desktop",
    "keyboard": "desktop",
    "touch": "touch",
    "xr-controller": "vr",
    "xr-hand": "vr",
    "scripted": "scripted",
}
"""Which devices are analysed together."""

Kind = Literal["person", "scripted"]
"""Who played: a script is never called a person."""
EpisodeKind = Literal["practise", "play"]
"""Practice is benign play on the participant's own device: the control block of that device."""
Question = Literal["correspondence", "goal", "danger", "naturalness"]
"""`correspondence`: which of two matches the reference (section 5.2). The others are scales from 0
to 7 (appendix 'Additional User Study'): how well the robot achieves the goal, how much danger it
causes, how close the motion is to the canonical one."""


@dataclass(frozen=True, kw_only=True)
class Participant:
    """One participant, as the study knows them: a code, never a name."""

    code: str
    """Pseudonym, such as P07; the token of the link is not kept beside it in exports."""
    kind: Kind
    role: str
    """A role of the study's file, such as novice, expert or rater."""
    external_id: str | None
    """Given by a recruiting platform, if any; left out of exports that are shared."""
    status: Literal["invited", "active", "done", "stopped"]
    """Those who withdraw are deleted, so that there is no status for them."""
    consent_version: str | None
    sharing: bool
    """Whether they agreed, separately, that their data may be shared beyond the study."""
    joined: str | None
    """When they consented, UTC, ISO 8601."""
    demographics: Mapping[str, Any]
    calibration: Mapping[str, float]
    """Metres: `arm_length`, `seat_height`; empty where nothing was calibrated."""
    place: int | None = None
    """Place among those of this role and kind who consented, from 0: counterbalances robots. The
    place of one who withdraws is given again. None before consent."""


@dataclass(frozen=True, kw_only=True)
class EpisodeArrays:
    """One episode, whole: all that is needed to judge it and to play it again."""

    states: Float[np.ndarray, "T1 state"]
    """`World.snapshot` after the reset and after each step."""
    features: Float[np.ndarray, "T F"]
    human_observations: Float[np.ndarray, "T H"]
    """What the played human sees, before each step."""
    robot_observations: Float[np.ndarray, "T R"]
    human_actions: Float[np.ndarray, "T A"]
    """Made of the hand target by damped least squares, in [-1, 1]."""
    robot_actions: Float[np.ndarray, "T B"]
    rewards: Float[np.ndarray, " T"]
    unwanted_force: Float[np.ndarray, " T"]
    """Largest force of the robot on the person in the step where it should not touch [N]."""
    faulted: Bool[np.ndarray, " T"]
    """Steps from which on the physics had run away."""
    targets: Float[np.ndarray, "T 3"]
    """Where the participant held the hand target, as it was used [m]."""
    target_age: Float[np.ndarray, " T"]
    """How old that target was when the step began [s]; inf before the first came."""
    step_times: Float[np.ndarray, " T"]
    """When each step began, on the server's clock, since the episode's start [s]."""

    def to_bytes(self) -> bytes:
        """An `.npz` without pickle."""
        buffer = io.BytesIO()
        np.savez_compressed(
            buffer, allow_pickle=False, **{f.name: getattr(self, f.name) for f in fields(self)}
        )
        return buffer.getvalue()

    @classmethod
    def from_bytes(cls, data: bytes) -> EpisodeArrays:
        """What `to_bytes` wrote."""
        with np.load(io.BytesIO(data), allow_pickle=False) as stored:
            return cls(**{f.name: stored[f.name] for f in fields(cls)})


@dataclass(frozen=True, kw_only=True)
class PlayedRecord:
    """A finished episode and how it ended."""

    participant: str
    """The code."""
    number: int
    """Place among the participant's episodes of this kind, from 0."""
    kind: EpisodeKind
    role: str
    robot: str
    """Key of the robot in the study's file."""
    device: Device
    seed: int
    """Of the start: with the human's actions it gives the whole episode again."""
    attempts: int
    """1 unless the connection dropped and the episode began anew."""
    episode_return: float
    success: float
    """1 or 0; NaN where the task defines none."""
    outcome: str
    peak_force: float
    """[N]."""
    impulse: float
    """[N s]."""
    started: str
    """UTC, ISO 8601."""
    about_device: Mapping[str, Any]
    """What the browser says of itself: screen, frames a second, round trip."""
    arrays: EpisodeArrays
    stage: int | None = None
    """Place in the role's stages, which says how the participant was asked to play; the store sets
    it."""


@dataclass(frozen=True, kw_only=True)
class Answer:
    """One answer of a participant."""

    participant: str
    stage: int
    """Place of the questionnaire in the role's stages."""
    trial: str
    """Id of the trial, such as t07."""
    question: Question
    pair: int | None
    """Place in the pair file; None for an attention check."""
    shown_left: Literal["first", "second"]
    """Which member of the pair stood on the left."""
    position: int
    """When it was asked: place in this participant's own order, from 0."""
    of: Literal["first", "second", "both"]
    """Which member a scale is about; `both` where the two are compared."""
    response: float
    """0 to 7; for `correspondence` 1 where the pair's second member was chosen, else 0."""
    rt: float
    """How long it took [s]."""
    passed: bool | None
    """Of an attention check; None for all else."""
    answered: str
    """UTC, ISO 8601."""


def as_json_text(value: Mapping[str, Any]) -> str:
    """For columns of the database that hold JSON: equal values give equal text."""
    return json_text(value)

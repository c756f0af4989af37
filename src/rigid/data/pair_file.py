"""Pairs of episodes for a study, on disk: `docs/pairs.md` says what every field means.

A member names an episode and does not hold it: run directories keep its states, a recording its
seed and what the human did, which the measured robot answers again.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    NonNegativeFloat,
    NonNegativeInt,
    PositiveInt,
    model_validator,
)

from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically
from rigid.frontier.schema import Share
from rigid.headers import parse_header

FORMAT_VERSION = 1
_CURE = "copy the file again, or pick the pairs again with `rigid pairs`"
_Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
_Id = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]+$")]

Shown = Literal["worst", "median"]
SHOWN: tuple[Shown, ...] = ("worst", "median")
"""The episodes of an adversary that a run directory keeps, in their order there."""


class _Part(BaseModel):
    """Unknown fields are allowed: the format grows by adding."""

    model_config = ConfigDict(frozen=True, strict=True, allow_inf_nan=False)


class RunSource(_Part):
    """A run directory."""

    path: str
    """From the folder of this file, or absolute."""
    robot: str
    """Who was measured, as the user named it."""
    robot_sha256: str
    """`settings.json`, identity."""
    episodes_sha256: Mapping[_Id, _Sha256]
    """Of `adversaries/ID/episodes.npz` of every adversary that a pair needs."""


class RecordingSource(_Part):
    """A file of episodes that somebody recorded, all of one human."""

    path: str
    """From the folder of this file, or absolute."""
    sha256: _Sha256
    """Of the file."""
    source: Literal["recorded", "synthetic"]
    """Whether the human was a person or a policy."""


class _Episode(_Part):
    """What every member has."""

    episode: NonNegativeInt
    """Place among the scored episodes of its adversary, or in the recording."""
    seed: NonNegativeInt
    """Of its start."""
    naturalness: Share
    """Of its human."""
    naturalness_se: NonNegativeFloat | None
    """Standard error of that over episodes; null where it is unknown."""
    adversarialness: Share
    """Of this episode."""
    snapshot: NonNegativeInt
    """The moment to show as a still: control steps since the start."""
    snapshot_by: Literal["force", "deviation"]
    """Which part of the rule chose it."""


class FoundMember(_Episode):
    """An episode of an adversary; a run directory has its states."""

    origin: Literal["run"] = "run"
    point: _Id
    """Id of the adversary."""
    shown: Shown
    """Which of the two episodes of it that are kept."""


class RecordedMember(_Episode):
    """A recorded episode: from the same start, the robot meets the same actions of the human."""

    origin: Literal["recording"] = "recording"
    recording: NonNegativeInt
    """Place in `recordings`."""
    referee_run: NonNegativeInt
    """Place in `runs`."""
    referee: _Id
    """The adversary there whose referee judged; `naturalness` is an upper bound."""


Member = Annotated[FoundMember | RecordedMember, Field(discriminator="origin")]


class Reference(_Part):
    """Canonical play that a pair is held against: kept beside an episode of an adversary."""

    point: _Id
    shown: Shown
    seed: NonNegativeInt


class Pair(_Part):
    """Two episodes to show side by side; on which side each goes is for the study to draw."""

    run: NonNegativeInt
    """Place in `runs`: whose robot both met, and whose referees judged both."""
    first: Member
    second: Member
    """The more adversarial one (kind danger), the more natural one (naturalness), the recorded one
    (faithfulness)."""
    reference: Reference


class PairRule(_Part):
    """What made two episodes a pair."""

    alike: Literal["naturalness", "adversarialness"]
    alike_below: Share
    different: Literal["naturalness", "adversarialness"] | None
    different_above: Share
    recorded_with_found: bool
    same_start: bool
    """Whether both humans start from the same, as far as naturalness sees it."""
    reuse: bool
    """Whether an episode may be in several pairs."""
    snapshot: str
    """How the moments were chosen, in words."""


class PairFile(_Part):
    """The whole file."""

    format: int = FORMAT_VERSION
    kind: Literal["danger", "naturalness", "faithfulness"]
    rule: PairRule
    seed: NonNegativeInt
    """The draw's."""
    eligible: PositiveInt
    """Pairs that the rule allows, of which these were drawn."""
    task: Mapping[str, Any]
    """`Task.describe()`."""
    runs: tuple[RunSource, ...]
    recordings: tuple[RecordingSource, ...]
    pairs: Annotated[tuple[Pair, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _refers_to_what_is_there(self) -> PairFile:
        for number, pair in enumerate(self.pairs):
            if pair.run >= len(self.runs):
                raise ValueError(f"pair {number} is of a run that is not listed")
            needed = {pair.reference.point}
            for member in (pair.first, pair.second):
                if isinstance(member, FoundMember):
                    needed.add(member.point)
                elif member.recording >= len(self.recordings):
                    raise ValueError(f"pair {number} is of a recording that is not listed")
                elif member.referee_run >= len(self.runs):
                    raise ValueError(f"pair {number} was judged by a run that is not listed")
            missing = needed - self.runs[pair.run].episodes_sha256.keys()
            if missing:
                raise ValueError(f"pair {number} needs {min(missing)!r}, whose hash is not listed")
        return self


def save_pairs(path: Path, pairs: PairFile) -> None:
    """Writes the file, whole or not at all; equal pairs give equal bytes."""
    write_atomically(path, json_text(pairs.model_dump(mode="json"), indent=1).encode() + b"\n")


def load_pairs(path: Path) -> PairFile:
    """Reads the file.

    Raises:
        UserError: It is missing, damaged, or of a newer format version.
    """
    text = read_bytes(path, cure="pick pairs with `rigid pairs`")
    return parse_header(PairFile, text, version=FORMAT_VERSION, where=path, cure=_CURE)


def relative_to(path: Path, file: Path) -> str:
    """A source's `path` as it stands in `file`: both may move together."""
    return Path(os.path.relpath(path.resolve(), file.resolve().parent)).as_posix()


def source_path(file: Path, source: RunSource | RecordingSource) -> Path:
    """Where a source of the pairs in `file` lies."""
    return file.parent / source.path


def file_hash(path: Path) -> str:
    """SHA-256 of a file.

    Raises:
        UserError: It cannot be read.
    """
    cure = "pairs name episodes and do not hold them, so put it back"
    return hashlib.sha256(read_bytes(path, cure=cure)).hexdigest()


def check_sources(file: Path, pairs: PairFile) -> None:
    """Makes sure that the episodes are still those that were picked.

    Raises:
        UserError: A file that holds some is missing or has changed.
    """
    for recording in pairs.recordings:
        _check(source_path(file, recording), recording.sha256)
    for run in pairs.runs:
        for name, expected in run.episodes_sha256.items():
            _check(source_path(file, run) / "adversaries" / name / "episodes.npz", expected)


def _check(path: Path, expected: str) -> None:
    if file_hash(path) != expected:
        raise UserError(
            f"{path} has changed since pairs were picked from it: put the old one back, or pick "
            "again with `rigid pairs`"
        )

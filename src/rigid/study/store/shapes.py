"""What the store hands out besides the records of `rigid.study.records`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from rigid.errors import UserError
from rigid.study.records import Kind, Participant


class GoneError(UserError):
    """There is no such participant (any more), or none who may still write: stopped, no consent."""


class ConflictError(UserError):
    """Something else was stored there before, and is kept."""


class Invitation(NamedTuple):
    """A new participant, and the only moment at which anybody sees the token."""

    code: str
    token: str
    """Of the link. The store keeps its SHA-256 alone."""


@dataclass(frozen=True, kw_only=True)
class Standing:
    """How far a participant has come: all that `rigid.study.flow` needs to know."""

    participant: Participant
    demographics_given: bool
    """Also where every question was skipped."""
    watched: Mapping[int, frozenset[str]]
    """By stage: ids of the episodes that were watched to their end."""
    played: Mapping[int, int]
    """By stage, practice too: number of finished episodes."""
    answered: Mapping[int, frozenset[str]]
    """By stage: ids of the trials that were answered."""


class ParticipantProgress(NamedTuple):
    """One line of the admin's page."""

    code: str
    kind: Kind
    role: str
    external_id: str | None
    status: str
    episodes: int
    answers: int
    last_seen: str | None
    """When something of theirs was stored last, UTC, ISO 8601."""


class Progress(NamedTuple):
    """The admin's page."""

    participants: tuple[ParticipantProgress, ...]
    withdrawn: tuple[str, ...]
    """Codes of those who are deleted."""
    refused: Mapping[str, int]
    """How many messages were refused, by reason."""


class Export(NamedTuple):
    """An export that was written."""

    path: Path
    """Its directory, absolute."""
    shareable: bool
    """Only those are in it who agreed to sharing."""
    licence: str | None
    codes: tuple[str, ...]
    """Whose data is in it."""

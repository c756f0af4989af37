"""Participants in the database: who they are, what they agreed to, how far they came.

Functions of a connection inside a transaction of the store's.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any, Literal

from rigid.study.records import Kind, Participant, as_json_text
from rigid.study.store.shapes import (
    GoneError,
    Invitation,
    ParticipantProgress,
    Standing,
)
from rigid.study.store.tokens import new_token, token_hash

FIRST_CONSENT = "first_consent"
"""The day of it; from then on the study is fixed, whoever withdraws."""
_LETTERS: Mapping[Kind, str] = {"person": "P", "scripted": "S"}

_PARTICIPANTS = """
SELECT p.*, c.version, c.sharing FROM participants p
LEFT JOIN consents c ON c.id = (SELECT max(id) FROM consents WHERE code = p.code)
"""
"""With the newest consent, which is the one that counts."""
_ORDER = "ORDER BY p.kind, length(p.code), p.code"

_PROGRESS = """
SELECT p.*,
  (SELECT count(*) FROM episodes WHERE participant = p.code) AS episodes,
  (SELECT count(*) FROM answers WHERE participant = p.code) AS answers,
  max(
    coalesce(p.joined, ''),
    coalesce((SELECT max(stored) FROM episodes WHERE participant = p.code), ''),
    coalesce((SELECT max(answered) FROM answers WHERE participant = p.code), ''),
    coalesce((SELECT max(at) FROM watched WHERE code = p.code), '')
  ) AS last_seen
FROM participants p
"""

Facts = Literal["demographics", "calibration"]
_SET: Mapping[Facts, str] = {
    "demographics": "UPDATE participants SET demographics = ? WHERE code = ?",
    "calibration": "UPDATE participants SET calibration = ? WHERE code = ?",
}


def now() -> str:
    """UTC, ISO 8601."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def invite(db: sqlite3.Connection, role: str, *, external_id: str | None, kind: Kind) -> Invitation:
    """A new participant. Numbers are never given twice, even if their owner withdrew."""
    letter = _LETTERS[kind]
    name = f"last_{letter}"
    found = db.execute("SELECT value FROM meta WHERE name = ?", (name,)).fetchone()
    number = 1 + (int(found["value"]) if found else 0)
    db.execute("INSERT OR REPLACE INTO meta VALUES (?, ?)", (name, str(number)))
    code, token = f"{letter}{number:02}", new_token()
    db.execute(
        "INSERT INTO participants (code, kind, role, external_id, token_sha256, status, invited)"
        " VALUES (?, ?, ?, ?, ?, 'invited', ?)",
        (code, kind, role, external_id, token_hash(token), now()),
    )
    return Invitation(code, token)


def participants(db: sqlite3.Connection) -> tuple[Participant, ...]:
    """Everybody but those who withdrew, by code."""
    return tuple(_participant(row) for row in db.execute(f"{_PARTICIPANTS} {_ORDER}"))


def by_token(db: sqlite3.Connection, token: str) -> Participant | None:
    """Whose link it is."""
    # Found by its hash, so that the time it takes tells nothing of the token.
    where = (token_hash(token),)
    row = db.execute(f"{_PARTICIPANTS} WHERE p.token_sha256 = ?", where).fetchone()
    return None if row is None else _participant(row)


def by_code(db: sqlite3.Connection, code: str) -> Participant:
    """A participant; raises `GoneError`."""
    row = db.execute(f"{_PARTICIPANTS} WHERE p.code = ?", (code,)).fetchone()
    if row is None:
        raise GoneError(f"there is no participant {code!r}: they withdrew, or were never invited")
    return _participant(row)


def writing(db: sqlite3.Connection, code: str) -> Participant:
    """A participant who may still send something; raises `GoneError` for all others."""
    found = by_code(db, code)
    if found.status == "stopped":
        raise GoneError(f"{code} has stopped: nothing more is stored of them")
    if found.status == "done":
        raise GoneError(f"{code} is done: nothing more is stored of them")
    if found.consent_version is None:
        raise GoneError(f"{code} has not consented: nothing is stored of them before they do")
    return found


def consent(db: sqlite3.Connection, code: str, version: str, *, sharing: bool) -> None:
    """Stores a consent beside earlier ones; the first makes the participant an active one."""
    found = by_code(db, code)
    if found.status == "stopped":
        raise GoneError(f"{code} has stopped: nothing more is stored of them")
    if (found.consent_version, found.sharing) == (version, sharing):
        return
    at = now()
    db.execute(
        "INSERT INTO consents (code, version, sharing, at) VALUES (?, ?, ?, ?)",
        (code, version, int(sharing), at),
    )
    if found.status == "invited":
        db.execute("INSERT OR IGNORE INTO meta VALUES (?, ?)", (FIRST_CONSENT, at[:10]))
        db.execute(
            "UPDATE participants SET status = 'active', joined = ?, place = ? WHERE code = ?",
            (at, _free_place(db, found), code),
        )


def _free_place(db: sqlite3.Connection, who: Participant) -> int:
    """The smallest that nobody has: also those who come for one who withdrew balance the robots."""
    rows = db.execute(
        "SELECT place FROM participants WHERE role = ? AND kind = ? AND place IS NOT NULL",
        (who.role, who.kind),
    )
    taken = {int(row["place"]) for row in rows}
    return next(place for place in range(len(taken) + 1) if place not in taken)


def set_facts(db: sqlite3.Connection, code: str, which: Facts, values: Mapping[str, Any]) -> None:
    """Replaces what the participant told of themselves."""
    writing(db, code)
    db.execute(_SET[which], (as_json_text(values), code))


def set_status(db: sqlite3.Connection, code: str, status: str) -> None:
    """`done` after `active`, `stopped` after `active` or `invited`; else nothing changes."""
    by_code(db, code)
    before = ("active", "active") if status == "done" else ("active", "invited")
    db.execute(
        "UPDATE participants SET status = ? WHERE code = ? AND status IN (?, ?)",
        (status, code, *before),
    )


def standing(db: sqlite3.Connection, code: str) -> Standing:
    """How far a participant has come; raises `GoneError`."""
    who = by_code(db, code)
    told = db.execute("SELECT demographics FROM participants WHERE code = ?", (code,)).fetchone()
    played = db.execute(
        "SELECT stage, count(*) AS n FROM episodes WHERE participant = ? GROUP BY stage", (code,)
    )
    return Standing(
        participant=who,
        demographics_given=told["demographics"] is not None,
        watched=_by_stage(db.execute(
            "SELECT stage, episode AS id FROM watched WHERE code = ?", (code,))),
        played={int(row["stage"]): int(row["n"]) for row in played},
        answered=_by_stage(db.execute(
            "SELECT DISTINCT stage, trial AS id FROM answers WHERE participant = ?", (code,))),
    )  # fmt: skip


def progress(db: sqlite3.Connection) -> tuple[ParticipantProgress, ...]:
    """A line for each participant."""
    return tuple(
        ParticipantProgress(
            code=row["code"], kind=row["kind"], role=row["role"], external_id=row["external_id"],
            status=row["status"], episodes=row["episodes"], answers=row["answers"],
            last_seen=row["last_seen"] or None,
        )
        for row in db.execute(f"{_PROGRESS} {_ORDER}")
    )  # fmt: skip


def _by_stage(rows: sqlite3.Cursor) -> dict[int, frozenset[str]]:
    found: dict[int, set[str]] = {}
    for row in rows:
        found.setdefault(int(row["stage"]), set()).add(str(row["id"]))
    return {stage: frozenset(ids) for stage, ids in found.items()}


def _participant(row: sqlite3.Row) -> Participant:
    return Participant(
        code=row["code"], kind=row["kind"], role=row["role"], external_id=row["external_id"],
        status=row["status"], consent_version=row["version"], sharing=bool(row["sharing"]),
        joined=row["joined"], demographics=json.loads(row["demographics"] or "{}"),
        calibration=json.loads(row["calibration"]), place=row["place"],
    )  # fmt: skip

"""Episodes and answers in the database: stored once, and the same one again is no other.

Functions of a connection inside a transaction of the store's.
"""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Iterator, Sequence
from dataclasses import fields

from rigid.study.records import Answer, EpisodeArrays, EpisodeKind, PlayedRecord, as_json_text
from rigid.study.store.people import now, writing
from rigid.study.store.shapes import ConflictError

_PLAIN = tuple(f.name for f in fields(PlayedRecord) if f.name not in {"about_device", "arrays"})
"""Fields whose columns hold just their value."""
_NUMBERS = ("episode_return", "success", "peak_force", "impulse")
"""SQLite has no NaN: it keeps NULL."""
_ANSWER = tuple(f.name for f in fields(Answer))
_SAID = ("pair", "shown_left", "position", "response", "passed")
"""What makes an answer another one; how long it took and when it came do not."""


def add_episode(db: sqlite3.Connection, record: PlayedRecord, stage: int, arrays: bytes) -> bool:
    """Stores an episode; False where it is there already.

    Args:
        db: The study's.
        record: The episode.
        stage: Place in the role's stages.
        arrays: `record.arrays` as bytes.

    Raises:
        GoneError: The participant may not send anything any more.
        ConflictError: Another one has its number.
    """
    there = db.execute(
        "SELECT seed, robot, stage, arrays FROM episodes"
        " WHERE participant = ? AND kind = ? AND number = ?",
        (record.participant, record.kind, record.number),
    ).fetchone()
    if there is not None:
        if tuple(there) == (record.seed, record.robot, stage, arrays):
            return False
        raise ConflictError(
            f"another {record.kind} episode {record.number} of {record.participant} is stored "
            "already, and stays"
        )
    writing(db, record.participant)
    values = {name: getattr(record, name) for name in _PLAIN} | {
        "stage": stage,
        "about_device": as_json_text(record.about_device),
        "arrays": arrays,
        "stored": now(),
    }
    _insert(db, "episodes", values)
    return True


def add_answers(db: sqlite3.Connection, answers: Sequence[Answer]) -> bool:
    """Stores answers, all or none; False where they are there already.

    Raises:
        GoneError: The participant may not send anything any more.
        ConflictError: The trial was answered otherwise.
    """
    new = [answer for answer in answers if not _is_there(db, answer)]
    for answer in new:
        writing(db, answer.participant)
        _insert(db, "answers", {name: getattr(answer, name) for name in _ANSWER})
    return bool(new)


def _is_there(db: sqlite3.Connection, answer: Answer) -> bool:
    there = db.execute(
        "SELECT * FROM answers WHERE participant = ? AND stage = ? AND trial = ?"
        " AND question = ? AND of = ?",
        (answer.participant, answer.stage, answer.trial, answer.question, answer.of),
    ).fetchone()
    if there is None:
        return False
    if any(there[name] != getattr(answer, name) for name in _SAID):
        raise ConflictError(
            f"{answer.participant} answered trial {answer.trial!r} of stage {answer.stage} "
            "otherwise before: the first answer stays"
        )
    return True


def _insert(db: sqlite3.Connection, table: str, values: dict[str, object]) -> None:
    names, marks = ", ".join(values), ", ".join("?" * len(values))
    db.execute(f"INSERT INTO {table} ({names}) VALUES ({marks})", tuple(values.values()))  # noqa: S608 - Our own names.


def begin_attempt(db: sqlite3.Connection, code: str, kind: EpisodeKind, number: int) -> int:
    """Counts an attempt at an episode; returns which it is, from 1."""
    writing(db, code)
    row = db.execute(
        "INSERT INTO attempts VALUES (?, ?, ?, 1)"
        " ON CONFLICT DO UPDATE SET attempts = attempts + 1 RETURNING attempts",
        (code, kind, number),
    ).fetchone()
    return int(row["attempts"])


def episode_ids(
    db: sqlite3.Connection, code: str | None, kind: EpisodeKind | None
) -> tuple[int, ...]:
    """Where the episodes lie, by participant, kind (practice first) and number."""
    rows = db.execute(
        "SELECT e.id FROM episodes e JOIN participants p ON p.code = e.participant"
        " WHERE (?1 IS NULL OR e.participant = ?1) AND (?2 IS NULL OR e.kind = ?2)"
        " ORDER BY p.kind, length(p.code), p.code, e.kind DESC, e.number",
        (code, kind),
    )
    return tuple(row["id"] for row in rows)


def episode(db: sqlite3.Connection, key: int) -> PlayedRecord | None:
    """An episode; None if its participant withdrew since."""
    row = db.execute("SELECT * FROM episodes WHERE id = ?", (key,)).fetchone()
    if row is None:
        return None
    plain = {name: row[name] for name in _PLAIN}
    known = {name: math.nan if row[name] is None else row[name] for name in _NUMBERS}
    return PlayedRecord(
        **plain | known,
        about_device=json.loads(row["about_device"]),
        arrays=EpisodeArrays.from_bytes(row["arrays"]),
    )


def answers(db: sqlite3.Connection, code: str | None) -> Iterator[Answer]:
    """Answers by participant, stage and position."""
    rows = db.execute(
        "SELECT a.* FROM answers a JOIN participants p ON p.code = a.participant"
        " WHERE ?1 IS NULL OR a.participant = ?1"
        " ORDER BY p.kind, length(p.code), p.code, a.stage, a.position, a.question, a.of",
        (code,),
    )
    for row in rows:
        values = {name: row[name] for name in _ANSWER}
        passed = values.pop("passed")
        yield Answer(**values, passed=None if passed is None else bool(passed))

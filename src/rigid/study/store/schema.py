"""The tables, and how they are opened.

SQLite in WAL mode: readers see whole transactions while one connection writes, and what was
committed outlives a killed process. `docs/study.md` describes the columns.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rigid.errors import UserError

FILE, LOCK = "study.sqlite3", "study.lock"
VERSION = 1
APPLICATION = int.from_bytes(b"RIGD", "big")
"""Marks the file as ours, for `file` and for the refusal of others."""
PATIENCE = 10.0
"""How long one connection waits for another's transaction [s]. Ours: transactions take
milliseconds, and VACUUM seconds."""

TABLES = """
CREATE TABLE meta (name TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE registered (name TEXT PRIMARY KEY, sha256 TEXT NOT NULL, at TEXT NOT NULL)
  STRICT, WITHOUT ROWID;
CREATE TABLE participants (
  code TEXT PRIMARY KEY,
  kind TEXT NOT NULL CHECK (kind IN ('person', 'scripted')),
  role TEXT NOT NULL,
  external_id TEXT,
  token_sha256 TEXT NOT NULL UNIQUE,
  status TEXT NOT NULL CHECK (status IN ('invited', 'active', 'done', 'stopped')),
  place INTEGER,
  invited TEXT NOT NULL,
  joined TEXT,
  demographics TEXT,
  calibration TEXT NOT NULL DEFAULT '{}'
) STRICT;
CREATE TABLE consents (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  code TEXT NOT NULL REFERENCES participants ON DELETE CASCADE,
  version TEXT NOT NULL, sharing INTEGER NOT NULL, at TEXT NOT NULL
) STRICT;
CREATE INDEX consents_of ON consents (code);
CREATE TABLE watched (
  code TEXT NOT NULL REFERENCES participants ON DELETE CASCADE,
  stage INTEGER NOT NULL, episode TEXT NOT NULL, at TEXT NOT NULL,
  PRIMARY KEY (code, stage, episode)
) STRICT, WITHOUT ROWID;
CREATE TABLE attempts (
  code TEXT NOT NULL REFERENCES participants ON DELETE CASCADE,
  kind TEXT NOT NULL, number INTEGER NOT NULL, attempts INTEGER NOT NULL,
  PRIMARY KEY (code, kind, number)
) STRICT, WITHOUT ROWID;
CREATE TABLE episodes (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  participant TEXT NOT NULL REFERENCES participants ON DELETE CASCADE,
  kind TEXT NOT NULL CHECK (kind IN ('practise', 'play')),
  number INTEGER NOT NULL,
  stage INTEGER NOT NULL,
  role TEXT NOT NULL, robot TEXT NOT NULL, device TEXT NOT NULL,
  seed INTEGER NOT NULL, attempts INTEGER NOT NULL,
  episode_return REAL, success REAL, outcome TEXT NOT NULL, peak_force REAL, impulse REAL,
  started TEXT NOT NULL, stored TEXT NOT NULL,
  about_device TEXT NOT NULL,
  arrays BLOB NOT NULL,
  UNIQUE (participant, kind, number)
) STRICT;
CREATE TABLE answers (
  participant TEXT NOT NULL REFERENCES participants ON DELETE CASCADE,
  stage INTEGER NOT NULL, trial TEXT NOT NULL, question TEXT NOT NULL, pair INTEGER,
  shown_left TEXT NOT NULL, position INTEGER NOT NULL, of TEXT NOT NULL,
  response REAL NOT NULL, rt REAL NOT NULL, passed INTEGER, answered TEXT NOT NULL,
  PRIMARY KEY (participant, stage, trial, question, of)
) STRICT, WITHOUT ROWID;
CREATE TABLE withdrawn (code TEXT PRIMARY KEY, at TEXT NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE refused (reason TEXT PRIMARY KEY, count INTEGER NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE exports (
  path TEXT PRIMARY KEY, at TEXT NOT NULL, shareable INTEGER NOT NULL, licence TEXT,
  codes TEXT NOT NULL
) STRICT, WITHOUT ROWID;
"""


def connect(path: Path) -> sqlite3.Connection:
    """A connection that reads and writes; makes file and tables where there are none.

    Raises:
        UserError: The file is no study, damaged, or of a newer RIGID; or cannot be written.
    """
    with told(path):
        path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        # Nobody else on the machine reads what people did; SQLite gives -wal and -shm the same.
        os.close(os.open(path, os.O_CREAT | os.O_RDWR, 0o600))
        db = _connected(path, "rw")
        try:
            for pragma in ("journal_mode=WAL", "secure_delete=ON", "temp_store=MEMORY"):
                db.execute(f"PRAGMA {pragma}").fetchone()
            if _version(db) == (0, 0):
                _make_tables(db)
            _check(db, path)
        except BaseException:
            db.close()
            raise
        return db


def connect_to_read(path: Path) -> sqlite3.Connection:
    """A connection that reads alone, also while others write.

    Raises:
        UserError: There is no study, or as `connect`.
    """
    if not path.is_file():
        raise UserError(
            f"{path.parent} holds no study ({path.name} is missing): name the directory that "
            "`rigid study serve --data` wrote"
        )
    with told(path):
        db = _connected(path, "ro")
        try:
            _check(db, path)
        except BaseException:
            db.close()
            raise
        return db


def refuse_study(data: Path) -> None:
    """Keeps what is to be a new study out of another's directory.

    Raises:
        UserError: There is one.
    """
    if (data / FILE).exists():
        raise UserError(f"{data} holds a study already: choose a directory of its own with --data")


def forget(data: Path) -> None:
    """Removes a study that was just made and holds nothing yet."""
    for name in (FILE, f"{FILE}-wal", f"{FILE}-shm", LOCK):
        (data / name).unlink(missing_ok=True)


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Turns what SQLite and the file system refuse into a message.

    Raises:
        UserError: It names the file.
    """
    try:
        yield
    except sqlite3.OperationalError as error:  # Locked, full, not writable.
        raise UserError(
            f"{path} cannot be used ({error}): see to free space, permissions, and that it lies on "
            "a local disk"
        ) from None
    except sqlite3.DatabaseError as error:
        if isinstance(error, sqlite3.IntegrityError | sqlite3.ProgrammingError):
            raise  # A mistake of ours.
        raise UserError(f"{path} is damaged or no study ({error}): restore a backup") from None
    except OSError as error:
        raise UserError(
            f"{path} cannot be written ({error.strerror}): choose another place with --data"
        ) from None


def _connected(path: Path, mode: str) -> sqlite3.Connection:
    # Threads share a connection behind the store's lock; transactions are begun by hand.
    db = sqlite3.connect(
        f"{path.absolute().as_uri()}?mode={mode}", uri=True, timeout=PATIENCE,
        isolation_level=None, check_same_thread=False,
    )  # fmt: skip
    db.row_factory = sqlite3.Row
    db.execute("PRAGMA foreign_keys=ON")
    return db


def _make_tables(db: sqlite3.Connection) -> None:
    db.execute("BEGIN IMMEDIATE")  # Another process may make them at the same moment.
    if not db.execute("SELECT count(*) FROM sqlite_schema").fetchone()[0]:
        for statement in TABLES.split(";")[:-1]:
            db.execute(statement)
        db.execute(f"PRAGMA application_id={APPLICATION}")
        db.execute(f"PRAGMA user_version={VERSION}")
    db.execute("COMMIT")


def _version(db: sqlite3.Connection) -> tuple[int, int]:
    names = ("application_id", "user_version")
    mark, version = (db.execute(f"PRAGMA {name}").fetchone()[0] for name in names)
    return int(mark), int(version)


def _check(db: sqlite3.Connection, path: Path) -> None:
    mark, version = _version(db)
    if mark == APPLICATION and version == VERSION:
        return
    if mark == APPLICATION and version > VERSION:
        raise UserError(
            f"{path} has format version {version}, but this RIGID reads up to {VERSION}: install a "
            "newer rigid-frontier"
        )
    raise UserError(f"{path} is a database of something else: choose another place with --data")

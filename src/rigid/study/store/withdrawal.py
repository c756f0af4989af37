"""Withdrawal: what a participant gave is deleted, down to the bytes of the files.

Deleting rows is not enough. SQLite writes zeros over what it frees (`secure_delete`), but older
pages live on in the write-ahead log until that is folded into the file and cut. A reader that is in
the middle of something keeps the log from being cut: then it is tried again later, and the database
remembers that it must be.
"""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path

from rigid.study.store.people import by_code, now

_PENDING = "scrub_pending"
_PATIENCE = 500
"""How long a reader is waited for [ms]; a service has others to serve meanwhile. Ours."""


def delete(db: sqlite3.Connection, code: str) -> tuple[Path, ...]:
    """Deletes all rows of a participant; inside a transaction.

    Returns:
        Exports that hold them.

    Raises:
        GoneError: There is no such participant.
    """
    by_code(db, code)
    db.execute("DELETE FROM participants WHERE code = ?", (code,))  # All else goes with it.
    # The day is enough: the second could be found again in other logs.
    db.execute("INSERT INTO withdrawn VALUES (?, ?)", (code, now()[:10]))
    db.execute("INSERT OR REPLACE INTO meta VALUES (?, '1')", (_PENDING,))
    rows = db.execute("SELECT path, codes FROM exports ORDER BY path")
    return tuple(Path(row["path"]) for row in rows if code in json.loads(row["codes"]))


def scrub(db: sqlite3.Connection) -> bool:
    """Removes deleted data from the files, if any is left there; outside of transactions.

    Returns:
        False: somebody is reading, so that it has to be tried again.
    """
    pending = db.execute("SELECT 1 FROM meta WHERE name = ?", (_PENDING,)).fetchone()
    if pending is None:
        return True
    before = db.execute("PRAGMA busy_timeout").fetchone()[0]
    db.execute(f"PRAGMA busy_timeout={_PATIENCE}")
    try:
        db.execute("VACUUM")  # Pages that were split or moved leave no copies behind.
        whole = _cut_log(db)
        if whole:
            db.execute("DELETE FROM meta WHERE name = ?", (_PENDING,))
    except sqlite3.OperationalError as error:
        if error.sqlite_errorcode & 0xFF == sqlite3.SQLITE_BUSY:
            return False
        raise
    finally:
        db.execute(f"PRAGMA busy_timeout={before}")
    return whole


def _cut_log(db: sqlite3.Connection) -> bool:
    """Folds the log into the file and empties it; False where a reader needs it still."""
    busy, _, _ = db.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
    return not busy

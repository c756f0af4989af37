"""The file of a study: its transactions."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from rigid.study.store import withdrawal
from rigid.study.store.schema import told


class StudyFile:
    """A connection to the database that threads may share."""

    def __init__(self, path: Path, db: sqlite3.Connection, lock: IO[str] | None = None) -> None:
        self.path = path
        """Of the database."""
        self._db, self._lock_file = db, lock
        self._lock = threading.RLock()

    def close(self) -> None:
        """Closes the files; other stores of the same study live on."""
        with self._lock:
            self._db.close()
            if self._lock_file is not None:
                self._lock_file.close()

    def scrub(self) -> bool:
        """Tries again to cut deleted data from the files; False: somebody is reading still."""
        with self._lock, told(self.path):
            return withdrawal.scrub(self._db)

    @contextmanager
    def snapshot(self) -> Iterator[None]:
        """Shows the study as it is now, whatever is stored meanwhile; for reading alone."""
        with self._lock, told(self.path):
            self._db.execute("BEGIN")
            self._db.execute("SELECT count(*) FROM meta").fetchone()  # It begins with a look.
            try:
                yield
            finally:
                self._db.execute("ROLLBACK")

    @contextmanager
    def _writing(self, *, durable: bool = True) -> Iterator[sqlite3.Connection]:
        """A transaction, on the disk when it ends; not `durable`: safe from kill -9 alone."""
        with self._lock, told(self.path):
            self._db.execute(f"PRAGMA synchronous={'FULL' if durable else 'NORMAL'}")
            self._db.execute("BEGIN IMMEDIATE")
            try:
                yield self._db
                self._db.execute("COMMIT")
            except BaseException:
                if self._db.in_transaction:
                    self._db.execute("ROLLBACK")
                raise

    @contextmanager
    def _reading(self) -> Iterator[sqlite3.Connection]:
        with self._lock, told(self.path):
            yield self._db

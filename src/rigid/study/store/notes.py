"""What the service itself keeps beside the data of participants."""

from __future__ import annotations

import hmac
import json
import secrets
from pathlib import Path

from rigid.study.store import people
from rigid.study.store.shapes import Export
from rigid.study.store.study_file import StudyFile
from rigid.study.store.tokens import token_hash

_ADMIN = "admin_token_sha256"
_IDENTITY = "identity"


class Notes(StudyFile):
    """Counts, times and hashes; nothing that a participant sent."""

    def fact(self, name: str) -> str | None:
        """A text that `register` kept."""
        with self._reading() as db:
            row = db.execute("SELECT value FROM meta WHERE name = ?", (name,)).fetchone()
            return None if row is None else str(row["value"])

    def identity(self) -> str:
        """A random word that tells this study's data from all others; the first who asks makes it.

        Copies of the data have the same.
        """
        with self._writing() as db:
            db.execute(
                "INSERT OR IGNORE INTO meta VALUES (?, ?)", (_IDENTITY, secrets.token_hex(8))
            )
            row = db.execute("SELECT value FROM meta WHERE name = ?", (_IDENTITY,)).fetchone()
            return str(row["value"])

    def count_refused(self, reason: str, count: int = 1) -> None:
        """Counts refused messages; the reason is one of the service's words, never their text."""
        with self._writing(durable=False) as db:
            db.execute(
                "INSERT INTO refused VALUES (?, ?)"
                " ON CONFLICT DO UPDATE SET count = count + excluded.count",
                (reason, count),
            )

    def set_admin_token(self, token: str) -> None:
        """Keeps its hash; the one before opens nothing any more."""
        with self._writing() as db:
            db.execute("INSERT OR REPLACE INTO meta VALUES (?, ?)", (_ADMIN, token_hash(token)))

    def has_admin(self) -> bool:
        """Whether there is one."""
        return self.fact(_ADMIN) is not None

    def is_admin(self, token: str) -> bool:
        """Whether it is the admin's token."""
        return hmac.compare_digest(self.fact(_ADMIN) or "", token_hash(token))

    def note_export(self, export: Export) -> None:
        """Remembers who is in an export, so that those who withdraw can be taken out of it."""
        with self._writing() as db:
            db.execute(
                "INSERT OR REPLACE INTO exports VALUES (?, ?, ?, ?, ?)",
                (str(export.path), people.now(), int(export.shareable), export.licence,
                 json.dumps(export.codes)),
            )  # fmt: skip

    def exports(self) -> tuple[Export, ...]:
        """What was exported, and who is in it."""
        with self._reading() as db:
            return tuple(
                Export(Path(row["path"]), bool(row["shareable"]), row["licence"],
                       tuple(json.loads(row["codes"])))
                for row in db.execute("SELECT * FROM exports ORDER BY path")
            )  # fmt: skip

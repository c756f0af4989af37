"""What a study was registered as, in the database.

Functions of a connection inside a transaction of the store's.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from pathlib import Path

from rigid.errors import UserError
from rigid.files import json_text
from rigid.study.plan import StudyPlan, plan_hash
from rigid.study.store.people import FIRST_CONSENT, now

STUDY = "study"
_OF_VERSION = frozenset({"task", "analysis"})
_PLAN, _PATHS = "plan", "plan_paths"


def set_plan(db: sqlite3.Connection, plan: StudyPlan, data: Path) -> None:
    """Stores the plan; once somebody has consented, it has to be the one that is there.

    Raises:
        UserError: It is another one; or somebody was invited to a role that it lacks.
    """
    register(db, {STUDY: plan_hash(plan)}, data)
    rows = db.execute("SELECT code, role FROM participants ORDER BY length(code), code")
    for code, role in rows:
        if role not in plan.roles:
            raise UserError(
                f"{code} was invited as {role!r}, but the study has only {', '.join(plan.roles)}: "
                "put the role back, or choose another directory with --data"
            )
    # Its paths are absolute, since the data may be analysed from another folder.
    facts = {_PLAN: plan.model_dump_json(), _PATHS: json_text(plan.paths)}
    db.executemany("INSERT OR REPLACE INTO meta VALUES (?, ?)", facts.items())


def plan(db: sqlite3.Connection) -> StudyPlan | None:
    """What `set_plan` stored."""
    wanted = "SELECT value FROM meta WHERE name = ?"
    found, paths = (db.execute(wanted, (name,)).fetchone() for name in (_PLAN, _PATHS))
    if found is None:
        return None
    stored = StudyPlan.model_validate_json(found["value"])
    return stored.model_copy(update={"paths": json.loads(paths["value"])})


def register(db: sqlite3.Connection, hashes: Mapping[str, str], data: Path) -> None:
    """Stores hashes; once somebody has consented, they have to be those that are there.

    Raises:
        UserError: The message names what changed, and what to do.
    """
    there, begun = registered(db), _first_consent(db)
    if begun is None:
        rows = ((name, value, now()) for name, value in hashes.items())
        db.executemany("INSERT OR REPLACE INTO registered VALUES (?, ?, ?)", rows)
        return
    for name, value in hashes.items():
        if there.get(name) == value:
            continue
        how = "has changed since it was registered" if name in there else "was not registered"
        # A newer RIGID may describe a task or analyse in another way.
        version = ", with the version of RIGID that it began with" if name in _OF_VERSION else ""
        raise UserError(
            f"{_spoken(name)} {how}, but the first participant of the study in {data} consented on "
            f"{begun}, and what people agreed to must stay: put it back as it was{version}, or "
            "begin a new study in another directory with --data"
        )


def registered(db: sqlite3.Connection) -> dict[str, str]:
    """SHA-256 by what is fixed."""
    return {row["name"]: row["sha256"] for row in db.execute("SELECT * FROM registered")}


def _first_consent(db: sqlite3.Connection) -> str | None:
    """The day when somebody consented first; also of those who withdrew since."""
    row = db.execute("SELECT value FROM meta WHERE name = ?", (FIRST_CONSENT,)).fetchone()
    return None if row is None else str(row["value"])


def _spoken(name: str) -> str:
    r"""What a registered name means to people.

    Example:
        >>> _spoken("study"), _spoken("pairs/danger.json")
        ('the study file', "the pair file 'danger.json'")
    """
    kind, _, which = name.partition("/")
    words = {
        STUDY: "the study file", "task": "the task", "analysis": "the analysis (its settings)",
        "pairs": f"the pair file {which!r}", "robots": f"robot {which!r}",
    }  # fmt: skip
    return words.get(kind, name)

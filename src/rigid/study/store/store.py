"""The store of one study: every method is one short transaction."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, final

from rigid.errors import UserError
from rigid.study.plan import StudyPlan
from rigid.study.records import Answer, EpisodeKind, Kind, Participant, PlayedRecord
from rigid.study.store import collected, fixed, people, withdrawal
from rigid.study.store.notes import Notes
from rigid.study.store.schema import FILE, LOCK, connect, connect_to_read, refuse_study, told
from rigid.study.store.shapes import Invitation, Progress, Standing


@final
class Store(Notes):
    """One study's data.

    What a method wrote is committed when it returns, and outlives a killed process. Threads may
    share a store. Readers in other processes see whole transactions, at any time.

    Every method raises `UserError` where the file cannot be read or written; those that take a
    participant's code raise `GoneError` where there is none.
    """

    @classmethod
    def open(cls, data: Path, plan: StudyPlan | None = None, *, new: bool = False) -> Store:
        """Opens the study in the directory `data` for the one process that serves it.

        Args:
            data: Directory; made if it is new.
            plan: What the study is; None leaves it as it was stored.
            new: Refuse a directory that holds a study already.

        Raises:
            UserError: Another process serves there; or the plan is not that to which somebody
                consented already; or there is a study.
        """
        with told(data / FILE):
            data.mkdir(parents=True, exist_ok=True, mode=0o700)
            lock = (data / LOCK).open("w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if new:  # Behind the lock: nobody makes one now.
                refuse_study(data)
            store = cls(data / FILE, connect(data / FILE), lock)
        except BlockingIOError:
            lock.close()
            raise UserError(
                f"another process serves the study in {data}: stop it first, or choose another "
                "directory with --data"
            ) from None
        except BaseException:
            lock.close()
            raise
        try:
            if plan is not None:
                with store._writing() as db:
                    fixed.set_plan(db, plan, data)
            store.scrub()
        except BaseException:
            store.close()
            raise
        return store

    @classmethod
    def edit(cls, data: Path) -> Store:
        """Opens it to write beside the process that serves: to withdraw, to note an export."""
        connect_to_read(data / FILE).close()  # Makes no study where there is none.
        return cls(data / FILE, connect(data / FILE))

    @classmethod
    def read(cls, data: Path) -> Store:
        """Opens it to read alone, also while it is served."""
        return cls(data / FILE, connect_to_read(data / FILE))

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    # What the study is.

    def plan(self) -> StudyPlan | None:
        """The plan that the data was collected by; None if nobody gave one."""
        with self._reading() as db:
            return fixed.plan(db)

    def register(self, hashes: Mapping[str, str], facts: Mapping[str, str] | None = None) -> None:
        """Fixes what must not change: study, pairs, analysis (`rigid.study.registration`).

        Args:
            hashes: SHA-256 by what is fixed.
            facts: Texts to keep beside them, by name.

        Raises:
            UserError: Somebody has consented, and something is not as it was then.
        """
        with self._writing() as db:
            fixed.register(db, hashes, self.path.parent)
            db.executemany("INSERT OR REPLACE INTO meta VALUES (?, ?)", (facts or {}).items())

    def registered(self) -> Mapping[str, str]:
        """What was registered."""
        with self._reading() as db:
            return fixed.registered(db)

    # Who takes part.

    def invite(
        self, role: str, *, external_id: str | None = None, kind: Kind = "person"
    ) -> Invitation:
        """A new participant, with the token of their link."""
        with self._writing() as db:
            return people.invite(db, role, external_id=external_id, kind=kind)

    def participants(self) -> tuple[Participant, ...]:
        """Everybody but those who withdrew."""
        with self._reading() as db:
            return people.participants(db)

    def participant(self, code: str) -> Participant:
        """One of them."""
        with self._reading() as db:
            return people.by_code(db, code)

    def participant_by_token(self, token: str) -> Participant | None:
        """Whose link it is; None for any other text."""
        with self._reading() as db:
            return people.by_token(db, token)

    def standing(self, code: str) -> Standing:
        """How far a participant has come: what `rigid.study.flow` goes by."""
        with self._reading() as db:
            return people.standing(db, code)

    def withdrawn(self) -> tuple[str, ...]:
        """Codes of those who withdrew, and are deleted."""
        with self._reading() as db:
            rows = db.execute("SELECT code FROM withdrawn ORDER BY length(code), code")
            return tuple(row["code"] for row in rows)

    def progress(self) -> Progress:
        """Everything that a study's leader wants to see at a glance."""
        with self._reading() as db:
            refused = {r["reason"]: r["count"] for r in db.execute("SELECT * FROM refused")}
            return Progress(people.progress(db), self.withdrawn(), refused)

    # What participants give. `GoneError` for those who stopped, are done, or have not consented.

    def consent(self, code: str, version: str, sharing: bool) -> None:
        """Stores that they agreed to a version of the consent; the newest counts.

        Args:
            code: The participant's.
            version: Of the text that they read.
            sharing: Whether they agreed as well that their data may be shared beyond the study.
        """
        with self._writing() as db:
            people.consent(db, code, version, sharing=sharing)

    def demographics(self, code: str, values: Mapping[str, Any]) -> None:
        """Stores what they tell of themselves; empty where they skip it all."""
        with self._writing() as db:
            people.set_facts(db, code, "demographics", values)

    def calibrate(self, code: str, values: Mapping[str, float]) -> None:
        """Stores the measures of their body [m]."""
        with self._writing() as db:
            people.set_facts(db, code, "calibration", values)

    def watched(self, code: str, stage: int, episode: str) -> None:
        """Stores that they watched an episode to its end; again is no other."""
        with self._writing() as db:
            people.writing(db, code)
            row = (code, stage, episode, people.now())
            db.execute("INSERT OR IGNORE INTO watched VALUES (?, ?, ?, ?)", row)

    def begin_attempt(self, code: str, kind: EpisodeKind, number: int) -> int:
        """Counts an attempt at an episode; returns which it is, from 1."""
        with self._writing(durable=False) as db:
            return collected.begin_attempt(db, code, kind, number)

    def add_episode(self, record: PlayedRecord, stage: int) -> bool:
        """Stores a finished episode, whole.

        Args:
            record: The episode.
            stage: Place in the role's stages.

        Returns:
            False: the same one is there already.

        Raises:
            ConflictError: Another one has its number.
        """
        arrays = record.arrays.to_bytes()
        with self._writing() as db:
            return collected.add_episode(db, record, stage, arrays)

    def add_answer(self, answer: Answer) -> bool:
        """As `add_answers`, of a trial that takes one answer."""
        return self.add_answers((answer,))

    def add_answers(self, answers: Sequence[Answer]) -> bool:
        """Stores all answers of a trial, or none.

        Returns:
            False: the same ones are there already.

        Raises:
            ConflictError: It was answered otherwise before.
        """
        with self._writing() as db:
            return collected.add_answers(db, answers)

    def finish(self, code: str) -> None:
        """They have done everything."""
        with self._writing() as db:
            people.set_status(db, code, "done")

    def stop(self, code: str) -> None:
        """They end their participation; what they gave is kept. Nothing for those who are done."""
        with self._writing() as db:
            people.set_status(db, code, "stopped")

    def withdraw(self, code: str) -> tuple[Path, ...]:
        """Deletes everything of theirs, down to the bytes of the files; leaves the code alone.

        Returns:
            Exports that hold them: `rigid.study.store.exports.correct` mends those on this machine.
        """
        with self._writing() as db:
            exports = withdrawal.delete(db, code)
        self.scrub()
        return exports

    # What was collected.

    def episodes(
        self, code: str | None = None, kind: EpisodeKind | None = None
    ) -> Iterator[PlayedRecord]:
        """Finished episodes by participant, kind (practice first) and number, one at a time."""
        with self._reading() as db:
            keys = collected.episode_ids(db, code, kind)
        for key in keys:
            with self._reading() as db:
                found = collected.episode(db, key)
            if found is not None:  # Nobody withdrew in between.
                yield found

    def answers(self, code: str | None = None) -> tuple[Answer, ...]:
        """Answers by participant, stage and position."""
        with self._reading() as db:
            return tuple(collected.answers(db, code))

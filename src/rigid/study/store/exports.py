"""Exports: a study's data as files, out of which those who withdraw are taken again."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from rigid import __version__
from rigid.errors import UserError
from rigid.files import writing_to
from rigid.study.plan import StudyPlan
from rigid.study.registration import TaskFacts, task_facts
from rigid.study.store.blocks import Terms, consent_in_words
from rigid.study.store.export_folder import check_place, holds_export, is_export, written_anew
from rigid.study.store.export_writing import Order, Written, write_files
from rigid.study.store.people import now
from rigid.study.store.shapes import Export
from rigid.study.store.store import Store


class Exported(NamedTuple):
    """What was written."""

    path: Path
    codes: tuple[str, ...]
    """Who is in it."""
    not_shared: tuple[str, ...]
    """Who is not, since they did not agree to sharing."""
    written: Written


class Corrected(NamedTuple):
    """An export that held somebody who withdrew."""

    path: Path
    codes: tuple[str, ...]
    """Whom."""
    mended: bool
    """False: it is no longer where it was written, so that somebody has to find it."""
    taken: bool = False
    """An export of other data is there now, and left alone."""

    def missing(self) -> str:
        """What there is to do about one that is not mended."""
        now_there = "holds other data's export now" if self.taken else "is no longer there"
        whom = ", ".join(self.codes)
        return f"{self.path} held {whom}, but {now_there}: delete them wherever it went"


def write_export(
    data: Path, out: Path, *, shareable: bool = False, licence: str | None = None
) -> Exported:
    """Writes a study's data as files, as they are now; also while it is served.

    Args:
        data: Directory of the study.
        out: New or empty directory, or one that holds an export of this data, which is written
            anew.
        shareable: Leave out who did not agree to sharing, and what leads to a person.
        licence: Under which others may use it, an SPDX identifier.

    Raises:
        UserError: There is no study, or `out` holds something else or cannot be written.
    """
    if licence is not None and not shareable:
        raise UserError(
            f"--licence {licence} lets others use the data, to which not all have agreed: add "
            "--shareable, which leaves out who has not"
        )
    out = out.absolute()
    while True:
        found = _written(data, out, shareable=shareable, licence=licence)
        with Store.edit(data) as store:
            # Somebody may have withdrawn meanwhile, while this held on to what they gave.
            store.scrub()
            if not set(found.codes) & set(store.withdrawn()):
                return found


def _written(data: Path, out: Path, *, shareable: bool, licence: str | None) -> Exported:
    with Store.read(data) as store, store.snapshot():
        everybody, plan = store.participants(), store.plan()
        people = tuple(who for who in everybody if who.sharing or not shareable)
        codes = tuple(who.code for who in people)
        facts, registered = _facts(store, plan), dict(store.registered())
        with Store.edit(data) as beside:
            identity = beside.identity()
            check_place(out, identity)
            # First: who withdraws from here on finds it.
            beside.note_export(Export(out, shareable, licence, codes))
        about = {
            "rigid": __version__, "written": now(), "title": None if plan is None else plan.title,
            "data": identity, "registered": registered, "shareable": shareable, "licence": licence,
            "participants": codes, "withdrawn": store.withdrawn(),
        }  # fmt: skip
        terms = Terms(consent_in_words(plan, people), licence, {
            "study": about["title"], "registered": registered,
        })  # fmt: skip
        order = Order(plan=plan, facts=facts, terms=terms, people=people, shareable=shareable)
        with writing_to(out), written_anew(out, about) as folder:
            written = write_files(store, folder, order)
    left_out = tuple(who.code for who in everybody if who.code not in codes)
    return Exported(out, codes, left_out, written)


def correct_exports(data: Path) -> tuple[Corrected, ...]:
    """Takes those who withdrew out of every export that holds them and is still where it was.

    A place that holds an export of other data by now is left alone.

    Raises:
        UserError: As `write_export`.
    """
    with Store.read(data) as store:
        gone = set(store.withdrawn())
        outdated = [export for export in store.exports() if gone & set(export.codes)]
    with Store.edit(data) as store:
        identity = store.identity()
    corrected = []
    for path, shareable, licence, codes in outdated:
        there = holds_export(path, identity)
        if there:
            write_export(data, path, shareable=shareable, licence=licence)
        whom = tuple(code for code in codes if code in gone)
        corrected.append(Corrected(path, whom, there, not there and is_export(path)))
    with Store.edit(data) as store:
        store.scrub()
    return tuple(corrected)


def _facts(store: Store, plan: StudyPlan | None) -> TaskFacts:
    """What was registered of the task; of studies that did not register, as it is today."""
    facts = task_facts(store)
    if facts is not None:
        return facts
    if plan is None:
        raise UserError(
            f"{store.path} does not say what was played: serve the study once with its file, as in "
            "rigid study serve --study FILE.yaml --data DIR"
        )
    if ":" in plan.task:  # It would run code that a stranger's data names.
        raise UserError(
            f"{store.path} does not describe its task {plan.task!r}: serve the study once more, "
            "which stores the description"
        )
    from rigid.tasks.registry import make_task

    found = task_facts(store, make_task(plan.task))
    assert found is not None
    return found

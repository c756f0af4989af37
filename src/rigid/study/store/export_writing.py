"""The files of an export: tables, whole episodes, and episodes as measurements read them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from rigid.data.episodes import save_episodes
from rigid.study.plan import StudyPlan
from rigid.study.records import DeviceClass, Kind, Participant, PlayedRecord
from rigid.study.registration import TaskFacts
from rigid.study.store import tables
from rigid.study.store.blocks import (
    Terms,
    canonical_episodes,
    device_class,
    is_whole,
    manner,
)
from rigid.study.store.export_folder import Folder
from rigid.study.store.store import Store


@dataclass
class Written:
    """What has been written so far."""

    episodes: int = 0
    answers: int = 0
    faulted: int = 0
    """Episodes in no canonical file, since their physics ran away."""
    blocks: list[str] = field(default_factory=list)
    """Canonical files of everybody's practice."""


@dataclass(frozen=True, kw_only=True)
class Order:
    """What is to be exported, and how."""

    plan: StudyPlan | None
    facts: TaskFacts
    terms: Terms
    people: Sequence[Participant]
    shareable: bool


def write_files(store: Store, folder: Folder, order: Order) -> Written:
    """Writes everything but the manifest."""
    written = Written()
    rows: list[tables.Row] = []
    practice: dict[tuple[DeviceClass, str, Kind], list[PlayedRecord]] = {}
    for who in order.people:
        own = list(store.episodes(who.code))  # Few, and small: no study plays for hours.
        rows += [_whole_episode(folder, order.plan, record, who.kind) for record in own]
        sound = [record for record in own if is_whole(record, order.facts)]
        written.faulted += len(own) - len(sound)
        for (group, robot, kind), records in _grouped(sound, who.kind).items():
            place = "canonical" if kind == "practise" else "played"
            _save(folder, order, f"{place}/{group}/{robot}/{who.code}.npz", records, who.kind)
            if kind == "practise":
                practice.setdefault((group, robot, who.kind), []).extend(records)
    for (group, robot, who_kind), records in practice.items():
        name = f"canonical/{group}/{robot}.npz"
        _save(folder, order, name, records, who_kind)
        written.blocks.append(name)
    written.episodes = len(rows)
    written.answers = _write_tables(store, folder, order, rows)
    return written


def _whole_episode(
    folder: Folder, plan: StudyPlan | None, record: PlayedRecord, kind: Kind
) -> tables.Row:
    name = f"episodes/{record.participant}-{record.kind}-{record.number}.npz"
    folder.put(name, record.arrays.to_bytes())
    return tables.episode_row(
        record, manner=manner(plan, record), device_class=device_class(record, kind), file=name
    )


def _grouped(
    records: Sequence[PlayedRecord], kind: Kind
) -> dict[tuple[DeviceClass, str, str], list[PlayedRecord]]:
    """By class of devices, robot, and whether they are practice."""
    found: dict[tuple[DeviceClass, str, str], list[PlayedRecord]] = {}
    for record in records:
        key = (device_class(record, kind), record.robot, record.kind)
        found.setdefault(key, []).append(record)
    return found


def _save(
    folder: Folder, order: Order, name: str, records: Sequence[PlayedRecord], kind: Kind
) -> None:
    episodes = canonical_episodes(
        records, order.facts, kind=kind, terms=order.terms, plan=order.plan
    )
    save_episodes(folder.path(name), episodes)
    folder.note(name)


def _write_tables(
    store: Store, folder: Folder, order: Order, episodes: Sequence[tables.Row]
) -> int:
    codes = {who.code for who in order.people}
    answers = [a for a in store.answers() if a.participant in codes]
    shareable = order.shareable
    people = [tables.participant_row(who, shareable=shareable) for who in order.people]
    rows = {
        "participants.csv": people,
        "episodes.csv": episodes,
        "answers.csv": [tables.answer_row(answer) for answer in answers],
        "withdrawn.csv": [{"code": code} for code in store.withdrawn()],
    }
    for name, lines in rows.items():
        folder.put(name, tables.table(name, lines, shareable=shareable))
    folder.put("README.md", _readme(order).encode())
    return len(answers)


def _readme(order: Order) -> str:
    title = "a study" if order.plan is None else order.plan.title
    licence = order.terms.licence or "none: do not pass these data on"
    return f"""# Data of {title}

{order.terms.consent} Licence: {licence}.

**These data are pseudonymous, not anonymous: motion can identify people.** Participants may
withdraw at any time, and `withdrawn.csv` names those who have: delete what you have of them, in
copies as well. `rigid study export` into this directory, or `rigid study withdraw`, writes it
anew without them: keep notes of your own elsewhere.

A referee can tell a device from a policy: compare within one class of devices alone. Episodes whose
physics ran away are in `episodes/` alone.

{tables.described(shareable=order.shareable)}
"""

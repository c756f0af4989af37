"""The tables of an export, as CSV, and what their columns mean."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from rigid.files import json_text
from rigid.study.records import Answer, DeviceClass, Participant, PlayedRecord
from rigid.study.service.demographics import QUESTIONS

Row = Mapping[str, Any]

COLUMNS: Mapping[str, Mapping[str, str]] = {
    "participants.csv": {
        "code": "pseudonym; what was not told stays empty",
        "kind": "person, or scripted (a program that stands for one)",
        "role": "of the study's file",
        "status": "invited, active, done or stopped; those who withdrew are in withdrawn.csv",
        "external_id": "of a recruiting platform",
        "consent_version": "the newest that they agreed to; empty: none",
        "sharing": "1: agreed that the data may be shared beyond the study",
        "joined": "when they consented, UTC",
        "place": "among those of the role, from 0; orders the robots",
        "arm_length": "m",
        "seat_height": "m",
        "age": "years; a span of five in exports to be shared",
        "gender": "woman, man, non-binary, self-described or undisclosed",
        "gender_description": "in their own words",
        "handedness": "right, left or both",
        "robot_experience": "1 (none) to 7",
        "vr_experience": "1 (none) to 7",
        "limited_arm": "whether the movement of an arm is limited: yes, no or undisclosed",
    },
    "episodes.csv": {
        "participant": "code",
        "kind": "practise (benign: the control block of the device) or play",
        "number": "among the participant's of this kind, from 0",
        "stage": "of the role, from 0",
        "manner": "how they were asked to play: as-watched, own-way, make-it-fail",
        "role": "of the study's file",
        "robot": "key in the study's file",
        "device": "mouse, keyboard, touch, xr-controller, xr-hand or scripted",
        "device_class": "desktop, touch, vr or scripted: compare within one alone",
        "seed": "of the start; with the human's actions it gives the episode again",
        "attempts": "1 unless the connection dropped and the episode began anew",
        "episode_return": "undiscounted; empty where the physics ran away",
        "success": "1 or 0 by the task's criterion; empty where it defines none",
        "outcome": "how it ended, in the task's words",
        "peak_force": "of the robot on the person, N",
        "impulse": "of the robot on the person, N s",
        "started": "UTC",
        "steps": "control steps",
        "longest_period": "between the beginnings of two steps, s",
        "file": "the episode, whole",
        "about_device": "what the browser said of itself, JSON",
    },
    "answers.csv": {
        "participant": "code",
        "stage": "of the role, from 0",
        "trial": "id",
        "question": "correspondence, goal, danger or naturalness",
        "pair": "place in the pair file, from 0; empty for an attention check",
        "shown_left": "which member of the pair stood on the left",
        "position": "when it was asked: place in the participant's own order, from 0",
        "of": "which member a scale is about; both: the two were compared",
        "response": "0 to 7; correspondence: 1 where the pair's second member was chosen, else 0",
        "rt": "how long it took, s",
        "passed": "of an attention check: 1 or 0",
        "answered": "UTC",
    },
    "withdrawn.csv": {"code": "delete what you have of them, wherever it is"},
}
"""Every column of every table."""

FILES: Mapping[str, str] = {
    "participants.csv, episodes.csv, answers.csv": "tables; their columns are below",
    "episodes/": "each episode whole, for `numpy.load`: its arrays are those of "
    "`rigid.study.records.EpisodeArrays`",
    "canonical/DEVICES/ROBOT.npz": "everybody's practice, natural behaviour of people with this "
    "robot: for `rigid frontier --canonical`",
    "canonical/DEVICES/ROBOT/CODE.npz": "the same of one participant",
    "played/DEVICES/ROBOT/CODE.npz": "what one participant played: for `rigid pairs --recordings`",
    "export.json": "when this was written, of what study, and a hash of each file",
}
"""What else is in an export."""

PRIVATE = frozenset(
    {"external_id", "joined", "started", "answered", "gender_description", "about_device"}
)
"""Columns that exports to be shared leave out: they lead to a person, or to when one was there."""


def table(name: str, rows: Iterable[Row], *, shareable: bool) -> bytes:
    """A table as CSV (UTF-8, one header line).

    Args:
        name: Of the file; its columns are `COLUMNS[name]`.
        rows: What is in each; what is missing stays empty.
        shareable: Leave out what is `PRIVATE`.
    """
    names = columns(name, shareable=shareable)
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(names)
    writer.writerows([_cell(row.get(column)) for column in names] for row in rows)
    return buffer.getvalue().encode()


def columns(name: str, *, shareable: bool) -> tuple[str, ...]:
    """The columns of a table, in order."""
    return tuple(column for column in COLUMNS[name] if not (shareable and column in PRIVATE))


def participant_row(who: Participant, *, shareable: bool) -> Row:
    """A line of participants.csv."""
    known = {question["id"] for question in QUESTIONS}
    told = {name: value for name, value in who.demographics.items() if name in known}
    if shareable and isinstance(told.get("age"), int | float):
        first = int(told["age"]) // 5 * 5
        told["age"] = f"{first}-{first + 4}"
    return {**asdict(who), **who.calibration, **told}


def episode_row(record: PlayedRecord, *, manner: str, device_class: DeviceClass, file: str) -> Row:
    """A line of episodes.csv."""
    times = record.arrays.step_times
    plain = {name: value for name, value in vars(record).items() if name != "arrays"}
    return plain | {
        "manner": manner,
        "device_class": device_class,
        "steps": len(times),
        "longest_period": float(np.diff(times).max()) if len(times) > 1 else math.nan,
        "file": file,
        "about_device": json_text(record.about_device),
    }


def answer_row(answer: Answer) -> Row:
    """A line of answers.csv."""
    return asdict(answer)


def described(*, shareable: bool) -> str:
    """Files and columns, in Markdown."""
    lines = ["| file | what it is |", "|---|---|"]
    lines += [f"| `{name}` | {what} |" for name, what in FILES.items()]
    for name in COLUMNS:
        lines += ["", f"## {name}", "", "| column | what it is |", "|---|---|"]
        lines += [f"| {c} | {COLUMNS[name][c]} |" for c in columns(name, shareable=shareable)]
    return "\n".join(lines)


def _cell(value: object) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, str) and value[:1] in {"=", "+", "-", "@", "\t", "\r"}:
        return f"'{value}"  # A spreadsheet would run what a stranger wrote.
    return repr(value) if isinstance(value, float) else str(value)

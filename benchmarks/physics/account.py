"""The account: a text filled from the table, so that the two cannot disagree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.paired import find, markdown
from benchmarks.physics.account_tables import (
    aged_table,
    closed_table,
    energy_table,
    number_text,
    verdict_table,
    window_table,
)
from benchmarks.physics.people import HUMAN, LOUD, ROBOT
from benchmarks.physics.plan import (
    DEEPEST,
    DEFAULT,
    FINEST,
    LIMITS,
    PAIRS,
    SETTINGS,
    SPEEDS,
    SWINGS,
    WINDOW_REFERENCE,
    Limit,
    Plan,
    Setting,
)
from benchmarks.physics.tables import Row, part_name
from benchmarks.physics.verdicts import broken, judged, remedy, rows_of, worst
from rigid.files import write_atomically
from rigid.tasks.physics.scene import CONTACT_TIME

_RESULTS = {"return": "return", "success": "success", "counted": "counted contacts"}
_TEMPLATE = Path(__file__).with_name("account.md")


def write_account(path: Path, plan: Plan, rows: Sequence[Row], parts: Mapping[str, Any]) -> None:
    """Writes the README of the results.

    Args:
        path: Its file.
        plan: The study.
        rows: Of the table.
        parts: The kept parts, for what the table does not hold.
    """
    windows = [parts[part_name("windows", pair)] for pair in PAIRS]
    text = _TEMPLATE.read_text(encoding="utf-8").format(
        stamp=plan.stamp, command=plan.command,
        default=DEFAULT.name, finest=FINEST.name, window_reference=WINDOW_REFERENCE.name,
        settings=_listed([one.name for one in SETTINGS]),
        verdict=headline(rows, DEFAULT), verdicts=verdict_table(rows),
        failures=failures(rows),
        closed=closed_table(rows), aged=aged_table(rows), shifts=shifts(rows),
        windows=window_table(rows), energy=energy_table(rows),
        touched=_listed([f"{100 * part['touched']:.0f} %" for part in windows]),
        convergence=convergence(rows), braked=braked(rows),
        costs=_costs(rows), softness=softness([part["softness"] for part in windows]),
        contact_time=CONTACT_TIME,
        robot=ROBOT, human=HUMAN, loud=LOUD, pairs=_listed([f"*{pair}*" for pair in PAIRS]),
        swings="\n".join(f"- *{name}*: {text}" for name, text in SWINGS.items()),
        fastest=max(row["value"] for row in rows if row["number"] == "fastest"),
        deepest=1000 * max(row["value"] for row in rows if row["number"] == "deepest"),
        fault=1000 * DEEPEST,
        speeds=_listed([f"{speed:g}" for speed in SPEEDS]),
        episodes=_listed([f"{plan.episodes[pair]} of *{pair}*" for pair in PAIRS]),
        recorded=plan.recorded, swing_count=plan.swings,
        swing_seconds=0.1 * plan.swing_steps, turns=plan.turns, window=0.1 * plan.window,
        window_count=len(PAIRS) * plan.recorded * (100 // plan.window),
    )  # fmt: skip
    write_atomically(path, text.encode())


def headline(rows: Sequence[Row], setting: Setting) -> str:
    """How many limits a step holds, and which it does not."""
    lost = broken(rows, setting)
    text = f"{setting.name} holds {len(LIMITS) - len(lost)} of {len(LIMITS)} limits"
    if not lost:
        return f"{text}: it is fine enough by every one."
    return f"{text}. It does not hold: {'; '.join(limit.text for limit in lost)}."


def failures(rows: Sequence[Row]) -> str:
    """For each limit that the task's step does not hold: by how much, and what would hold it."""
    lost = broken(rows, DEFAULT)
    return "\n".join(f"- {failure(rows, limit)}" for limit in lost) or "Nothing is broken."


def failure(rows: Sequence[Row], limit: Limit) -> str:
    """By how much the task's step misses one limit, where, and at which cost another holds it."""
    cases = []
    for row in rows_of(rows, limit, DEFAULT):
        verdict = judged(row, limit)
        if verdict != "holds":
            word = "" if verdict == "fails" else ", open"
            cases.append(f"*{row['case']}* {number_text(row)}{word}")
    return f"**{limit.text}**: {'; '.join(cases)}. {_cure(rows, limit)}"


def _cure(rows: Sequence[Row], limit: Limit) -> str:
    found = remedy(rows, limit)
    if found is not None:
        return f"{found[0].name} holds it and costs {found[1]:.1f} times the environment step."
    if worst(rows, limit, FINEST) is None:
        return f"No step holds it but {FINEST.name}, which is the reference."
    return f"No step holds it, {FINEST.name} neither."


def shifts(rows: Sequence[Row]) -> str:
    """Which results of episodes the task's step moves for certain, limit or no limit."""
    told = []
    for number, words in _RESULTS.items():
        for pair in PAIRS:
            row = find(rows, part="closed", case=pair, step=DEFAULT.step, number=number)
            if row["difference_low"] > 0 or row["difference_high"] < 0:
                told.append(f"{words} with *{pair}* {number_text(row)}")
    if not told:
        return f"No return, success or number of contacts at {DEFAULT.name} can be told from those."
    return f"Limits aside, some differences at {DEFAULT.name} are certain: {'; '.join(told)}."


def convergence(rows: Sequence[Row]) -> str:
    """By how much the errors of half seconds fall from the task's step to the finest."""
    parts = []
    for number, words in (("angles", "joint angles"), ("impulse_error", "impulses")):
        first, last = (
            [find(rows, part="windows", case=pair, step=one.step, number=number) for pair in PAIRS]
            for one in (DEFAULT, FINEST)
        )
        falls = [a["value"] / b["value"] for a, b in zip(first, last, strict=True) if b["value"]]
        if falls:
            parts.append(f"those of {words} by {min(falls):.0f} to {max(falls):.0f}")
    times = (DEFAULT.step - WINDOW_REFERENCE.step) / (FINEST.step - WINDOW_REFERENCE.step)
    return (
        f"From {DEFAULT.name} to {FINEST.name} errors fall, {', '.join(parts) or 'if there are'}; "
        f"errors in proportion to the step would by {times:.0f}, since {WINDOW_REFERENCE.name} has "
        "its own."
    )


def braked(rows: Sequence[Row]) -> str:
    """Whether servos take more energy than the task's step gives."""
    most = max(
        find(rows, part="energy", case=f"braked, {speed:g} rad/s", step=DEFAULT.step,
             number="worst")["value"]
        for speed in SPEEDS
    )  # fmt: skip
    told = f"at {DEFAULT.name} no braked swing is ever above its start"
    if most > 0:
        told = f"at {DEFAULT.name} a braked swing is above its start by {most:.2%} at most"
    return f"In the task a servo brakes every joint, and {told.replace('%', ' %')}."


def softness(found: Sequence[Mapping[str, Mapping[str, Any]]]) -> str:
    """Whether stiffness and damping were the same at all steps, from what MuJoCo used.

    Args:
        found: For each pair, by step: `windows.softness_of`.
    """
    values = {
        (key, round(end, 6))
        for pair in found for one in pair.values()
        for key in ("stiffness", "damping") for end in one[key]
    }  # fmt: skip
    count = sum(one["constraints"] for pair in found for one in pair.values())
    by_key = {
        key: sorted(end for name, end in values if name == key) for key in ("stiffness", "damping")
    }
    if not count:
        return "No state had a contact, so that nothing can be said of them."
    if len(values) != 2:
        return (
            f"**They are not equal**: k from {by_key['stiffness'][0]:g} to "
            f"{by_key['stiffness'][-1]:g} /s², b from {by_key['damping'][0]:g} to "
            f"{by_key['damping'][-1]:g} /s, so that no difference above is one of the step alone."
        )
    stiffness, damping = by_key["stiffness"][0], by_key["damping"][0]
    return (
        f"At the recorded states all {count:,} constraints of contacts and joint limits had "
        f"k = {stiffness:.1f} /s² and b = {damping:.1f} /s, at every step."
    )


def _costs(rows: Sequence[Row]) -> str:
    lines = []
    for one in SETTINGS:
        row = find(rows, part="cost", number="cost", step=one.step)
        speed = 1 / row["value"]
        lines.append([one.name, number_text(row), f"{speed:.2f}"])
    return markdown(["", "time of an environment step", "environment steps per second"], lines)


def _listed(words: Sequence[str]) -> str:
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))

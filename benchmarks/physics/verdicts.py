"""Which limits each step keeps: decided by the intervals and nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Literal

from benchmarks.paired import find
from benchmarks.physics.plan import LIMITS, SETTINGS, Limit, Setting
from benchmarks.physics.tables import Row

Verdict = Literal["holds", "fails", "open"]


def judged(row: Row, limit: Limit) -> Verdict:
    """Holds where the whole interval keeps the limit, fails where the whole interval breaks it.

    Where a row has a difference to the reference it is that which is held against the limit, else
    its value.
    """
    low, high = interval_of(row)
    least = -inf if limit.upper_only else -limit.bound
    if least <= low and high <= limit.bound:
        return "holds"
    if low > limit.bound or high < least:
        return "fails"
    return "open"


def interval_of(row: Row) -> tuple[float, float]:
    """What a limit is held against."""
    if row["difference"] is not None:
        return row["difference_low"], row["difference_high"]
    return row["low"], row["high"]


def rows_of(rows: Sequence[Row], limit: Limit, setting: Setting) -> list[Row]:
    """The rows that a limit speaks of at one step, a row for each case; none for the reference."""
    mine = [
        row for row in rows
        if (row["part"], row["number"], row["step"]) == (limit.part, limit.number, setting.step)
        and row["case"].startswith(limit.case)
    ]  # fmt: skip
    absolute = limit.number in {"faulted", "angles", "growth"}
    return [row for row in mine if absolute or row["difference"] is not None]


def worst(rows: Sequence[Row], limit: Limit, setting: Setting) -> Verdict | None:
    """The worst verdict over all cases; None where there is nothing to judge."""
    verdicts = {judged(row, limit) for row in rows_of(rows, limit, setting)}
    order: tuple[Verdict, ...] = ("fails", "open", "holds")
    return next((one for one in order if one in verdicts), None)


def remedy(rows: Sequence[Row], limit: Limit) -> tuple[Setting, float] | None:
    """The coarsest step that holds a limit in every case, and what it costs over the default."""
    for setting in SETTINGS:
        if worst(rows, limit, setting) == "holds":
            cost = find(rows, part="cost", number="cost", step=setting.step)["value"]
            return setting, float(cost)
    return None


def broken(rows: Sequence[Row], setting: Setting) -> list[Limit]:
    """The limits that a step does not hold in every case."""
    return [limit for limit in LIMITS if worst(rows, limit, setting) in {"fails", "open"}]

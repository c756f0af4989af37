"""Whether `standard` keeps the limit, decided by the intervals and nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from benchmarks.paired import Row, difference_text
from benchmarks.standard.plan import LIMIT

Verdict = Literal["met", "not met", "not enough seeds"]


def verdict(rows: Sequence[Row]) -> Verdict:
    """Whether every interval ends at -`LIMIT` or above.

    Args:
        rows: The deciding numbers of one robot.

    Example:
        >>> rows = [{"number": "auc", "difference_low": low} for low in (-0.01, -0.03)]
        >>> verdict(rows), verdict(rows[:1])
        ('not met', 'met')
    """
    if any(row["difference_low"] is None for row in rows):
        return "not enough seeds"
    return "not met" if _failing(rows) else "met"


def verdict_line(rows: Sequence[Row]) -> str:
    """The verdict on one robot with its numbers.

    Args:
        rows: The deciding numbers of the robot.
    """
    found, seeds = verdict(rows), rows[0]["seeds"]
    by = f" by {' and '.join(_failing(rows))}" if found == "not met" else ""
    count = f"{seeds} seed{'' if seeds == 1 else 's'}"
    numbers = ", ".join(f"`{row['number']}` {difference_text(row)}" for row in rows)
    return f"`{rows[0]['robot']}`: **{found}**{by} ({count}): {numbers}."


def _failing(rows: Sequence[Row]) -> list[str]:
    return [f"`{row['number']}`" for row in rows if row["difference_low"] < -LIMIT]

"""What the account says in words, decided by the intervals and nothing else."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.prediction.assembling import Row
from benchmarks.prediction.correlation import MIN_ROBOTS

LEVEL = 0.05
"""Of the permutation tests, as of the 95 % intervals."""


def told_from_chance(rows: Sequence[Row]) -> str:
    """Which numbers rank robots as their failures do, which against them, which neither.

    Both the interval and the permutation test have to say so: the interval of a handful of robots
    that are ranked without a slip is a point, whatever their number.
    """
    unknown = [row for row in rows if row["tau_low"] is None]
    told = [row for row in rows if row not in unknown and _excludes_zero(row)]
    neither = _names([row for row in rows if row not in unknown and row not in told])
    above = _names([row for row in told if row["tau"] > 0])
    below = _names([row for row in told if row["tau"] < 0])
    parts = [
        f"Told from chance (interval of τ above 0 and p ≤ {LEVEL:g}): {above or 'no number'}",
        f"against the claim, a worse number with fewer failures: {below}" if below else "",
        f"not told from chance: {neither}" if neither else "",
        f"undefined: {_names(unknown)}" if unknown else "",
    ]  # fmt: skip
    return "; ".join(part for part in parts if part) + "."


def against(row: Row) -> str:
    """Whether the first number of a contrast predicts better than the second."""
    first, second, difference = row["first"], row["second"], row["tau_difference"]
    low, high = row["tau_difference_low"], row["tau_difference_high"]
    if difference is None or low is None:
        return f"`{first}` and `{second}` cannot be compared: one of them is undefined here."
    numbers = f"difference of τ {difference:+.2f} [{low:.2f}, {high:.2f}]"
    if low > 0:
        return f"`{second}` predicts worse than `{first}`: {numbers}."
    if high < 0:
        return f"`{first}` predicts worse than `{second}`: {numbers}."
    lead = "neither is ahead"
    if difference:
        lead = f"`{first if difference > 0 else second}` is ahead in this sample"
    return f"`{first}` and `{second}` cannot be told apart: {numbers}; {lead}."


def among_competent(rows: Sequence[Row]) -> str:
    """What is left among robots that one would think of deploying."""
    count = rows[0]["n"]
    if count < MIN_ROBOTS:
        return f"Competent robots: {count}, too few to rank."
    return f"Competent robots alone ({count}). {told_from_chance(rows)}"


def _excludes_zero(row: Row) -> bool:
    apart = row["tau_low"] > 0 or row["tau_high"] < 0
    return bool(apart and row["tau_p"] <= LEVEL)


def _names(rows: Sequence[Row]) -> str:
    return ", ".join(f"`{row['predictor']}`" for row in rows)

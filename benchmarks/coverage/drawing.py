"""The figure: cover on whole searches by number of seeds, and on laws by their skewness."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.coverage.ends import CONFIDENCE, INTERVALS
from benchmarks.coverage.plan import PLAUSIBLE, Plan
from benchmarks.coverage.searching import NUMBERS
from benchmarks.coverage.tables import PRINTED, Row
from benchmarks.study import COLOURS, figure

_MARKERS = ("o", "s", "^")
"""First robot, second robot, their difference."""
_APART = 0.11
"""Between two series at one number of seeds [seeds]."""


def draw(path: Path, rows: Sequence[Row], plan: Plan) -> None:
    """Draws the table.

    Args:
        path: The figure's file.
        rows: Of the table.
        plan: The study.
    """
    with figure(path, columns=3, size=(11.0, 3.9)) as (left, middle, right):
        _searches(left, [row for row in rows if row["source"] == "searches"], plan)
        for axis, size in ((middle, plan.shown[0]), (right, plan.shown[-1])):
            laws = [row for row in rows if row["source"] == "law" and row["n"] == size]
            _laws(axis, laws, size)
        low = min(row["cover"] for row in rows)
        for axis in (left, middle, right):
            axis.set_ylim(max(low - 0.05, 0.0), 1.02)
        right.legend(loc="lower left", fontsize=7.5)


def _searches(axis: Any, rows: Sequence[Row], plan: Plan) -> None:
    """The printed interval on each number of each robot, with the error of having these seeds."""
    _mark(axis)
    for colour, name in zip(COLOURS, NUMBERS, strict=False):
        kinds = (*(f"tolerance {value:g}" for value in plan.tolerances), "difference")
        for place, (marker, kind) in enumerate(zip(_MARKERS, kinds, strict=True)):
            mine = [
                row for row in rows
                if (row["quantity"], row["interval"]) == (f"{name}, {kind}", PRINTED)
                and row["n"] in plan.sizes
            ]  # fmt: skip
            axis.errorbar(
                [row["n"] + _APART * (3 * NUMBERS.index(name) + place - 4) for row in mine],
                [row["cover"] for row in mine],
                [row["error_results"] for row in mine],
                fmt=marker, color=colour, markersize=3.5, elinewidth=0.7, label=f"{name}, {kind}",
            )  # fmt: skip
    axis.set_xticks(plan.sizes)
    axis.set_xlabel("search seeds in a draw")
    axis.set_ylabel("share of intervals that hold the truth")
    axis.set_title("Whole searches: t, as printed", fontsize=9)
    axis.legend(loc="lower right", fontsize=6.5)


def _laws(axis: Any, rows: Sequence[Row], size: int) -> None:
    """Every interval on every law, by skewness."""
    _mark(axis)
    for colour, marker, name in zip(COLOURS, _MARKERS, INTERVALS, strict=False):
        mine = [row for row in rows if row["interval"] == name]
        axis.plot(
            [row["skewness"] for row in mine], [row["cover"] for row in mine],
            marker, color=colour, markersize=4.5, label=name,
        )  # fmt: skip
        if name == PRINTED:
            for place, row in enumerate(mine):  # Names to either side, since some laws are close.
                side, align = ((-4, "right"), (4, "left"))[place % 2]
                axis.annotate(
                    row["quantity"], (row["skewness"], row["cover"]), xytext=(side, -8),
                    textcoords="offset points", fontsize=6, color="#5d6674", ha=align,
                )  # fmt: skip
    axis.set_xlabel("skewness of the law")
    axis.set_title(f"Laws of known mean: {size} seeds", fontsize=9)
    axis.margins(x=0.22)


def _mark(axis: Any) -> None:
    """The nominal cover, and the band that the account takes for it."""
    axis.axhspan(*PLAUSIBLE, color="#e4e1da", alpha=0.6, linewidth=0)
    axis.axhline(CONFIDENCE, color="#5d6674", linewidth=0.8)

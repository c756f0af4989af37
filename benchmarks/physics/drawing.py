"""The figure: differences against their limits, errors of half seconds, energy, and cost."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

from matplotlib.lines import Line2D

from benchmarks.paired import find
from benchmarks.physics.plan import (
    DEFAULT,
    FINEST,
    LIMITS,
    PAIRS,
    SETTINGS,
    SPEEDS,
    SWINGS,
    WINDOW_REFERENCE,
)
from benchmarks.physics.tables import Row
from benchmarks.physics.verdicts import interval_of
from benchmarks.study import COLOURS, figure

Style = Literal["-", "--", ":"]
_MARKERS = ("o", "s", "^")
_GREY = "#5d6674"
_FLOOR = 1e-5
"""A gain of energy below this is drawn here: rounding."""
_REACH = 2.2
"""How far the axis of differences goes, in limits."""


def draw(path: Path, rows: Sequence[Row]) -> None:
    """Draws the table into `path`."""
    with figure(path, columns=2, rows=2, size=(10.5, 8.0)) as axes:
        _limits(axes[0, 0], rows)
        _windows(axes[0, 1], rows)
        _energy(axes[1, 0], rows)
        _cost(axes[1, 1], rows)


def _limits(axis: Any, rows: Sequence[Row]) -> None:
    """Differences of closed loops, each in units of its limit."""
    limits = [limit for limit in LIMITS if limit.part == "closed"]
    steps = [one for one in SETTINGS if one != FINEST]
    axis.axvspan(-1, 1, color="#e4e1da", alpha=0.6, linewidth=0)
    axis.axvline(0, color=_GREY, linewidth=0.8)
    for place, limit in enumerate(limits):
        for number, setting in enumerate(steps):
            for order, pair in enumerate(PAIRS):
                row = find(
                    rows, part="closed", case=pair, step=setting.step, number=limit.number
                )  # fmt: skip
                y = place + 0.09 * (3 * number + order - 4)
                middle = row["value"] if row["difference"] is None else row["difference"]
                ends = [end / limit.bound for end in interval_of(row)]
                axis.plot(ends, [y, y], color=COLOURS[number], linewidth=1.0)
                marker = _MARKERS[order] + "-"
                axis.plot(middle / limit.bound, y, marker, color=COLOURS[number], markersize=3.5)
    names = [limit.text.replace(" of an episode", "").split(" of the range")[0] for limit in limits]
    axis.set_yticks(range(len(limits)), names)
    axis.set(ylim=(len(limits) - 0.5, -0.5), xlim=(-_REACH, _REACH))
    axis.set_xlabel(f"difference to {FINEST.name}, 1 = the limit")
    axis.set_title("Policies that act: grey keeps the limit", fontsize=9)
    lines = [_line(one.name, colour=COLOURS[number]) for number, one in enumerate(steps)]
    marks = [_line(pair, marker=_MARKERS[order]) for order, pair in enumerate(PAIRS)]
    axis.legend(handles=[*lines, *marks], fontsize=7, loc="lower left")


def _windows(axis: Any, rows: Sequence[Row]) -> None:
    """Errors of half seconds by step, on both axes in powers of ten."""
    kinds: dict[str, tuple[str, Style]] = {
        "peak_force": ("peak force, share", ":"),
        "impulse_error": ("impulse of a window, share", "--"),
        "angles": ("joint angles [canonical deviations]", "-"),
    }
    for number, (_, line) in kinds.items():
        for order, pair in enumerate(PAIRS):
            mine = [
                find(rows, part="windows", case=pair, step=one.step, number=number)
                for one in SETTINGS
            ]
            key = "difference" if number == "peak_force" else "value"
            axis.plot(
                [row["step"] for row in mine], [abs(row[key]) for row in mine], line,
                marker=_MARKERS[order], color=COLOURS[order], markersize=4,
            )  # fmt: skip
    _by_step(axis)
    axis.set_yscale("log")
    axis.set_title(f"Recorded targets for 0.5 s: error against {WINDOW_REFERENCE.name}", fontsize=9)
    lines = [_line(label, style=style) for label, style in kinds.values()]
    marks = [
        _line(pair, colour=COLOURS[order], marker=_MARKERS[order])
        for order, pair in enumerate(PAIRS)
    ]
    axis.legend(handles=[*lines, *marks], fontsize=7, loc="lower left")


def _energy(axis: Any, rows: Sequence[Row]) -> None:
    """Mean gain of energy by step; nothing is drawn at the floor."""
    for order, swing in enumerate(SWINGS):
        for style, speed in zip(("-", "--"), SPEEDS, strict=True):
            case = f"{swing}, {speed:g} rad/s"
            mine = [
                find(rows, part="energy", case=case, step=one.step, number="growth")
                for one in SETTINGS
            ]
            axis.plot(
                [row["step"] for row in mine], [max(row["value"], _FLOOR) for row in mine], style,
                marker=_MARKERS[order], color=COLOURS[order], markersize=4, label=case,
            )  # fmt: skip
    limit = next(one for one in LIMITS if one.part == "energy")
    axis.axhline(limit.bound, color=_GREY, linewidth=0.8)
    _by_step(axis)
    axis.set_yscale("log")
    axis.set(ylabel="highest gain of energy, share", ylim=(_FLOOR / 2, 2.0))
    axis.set_title("Swings, mean; line: the limit; lowest: no gain", fontsize=9)
    axis.legend(fontsize=7, loc="lower left", bbox_to_anchor=(0.0, 0.08))


def _cost(axis: Any, rows: Sequence[Row]) -> None:
    mine = [find(rows, part="cost", number="cost", step=one.step) for one in SETTINGS]
    values = [row["value"] for row in mine]
    ends = [[abs(row["value"] - row[end]) for row in mine] for end in ("low", "high")]
    axis.errorbar(
        [row["step"] for row in mine], values, ends, fmt="o-", color=COLOURS[0], markersize=4
    )
    for row in mine:
        axis.annotate(
            f"{row['value']:.1f}", (row["step"], row["value"]), xytext=(-4, 6), ha="right",
            textcoords="offset points", fontsize=8,
        )  # fmt: skip
    _by_step(axis)
    axis.set(ylabel=f"time of an environment step, {DEFAULT.name} = 1", ylim=(0, None))
    axis.set_title("Cost: processor time, in turns", fontsize=9)


def _line(
    label: str, *, colour: str = _GREY, marker: str | None = None, style: Style = "-"
) -> Line2D:
    """An entry of a legend; a marker in grey stands alone."""
    alone = marker is not None and colour == _GREY
    return Line2D(
        [], [], color=colour, marker=marker, linestyle="" if alone else style, markersize=4,
        label=label,
    )  # fmt: skip


def _by_step(axis: Any) -> None:
    """The steps along the axis, coarse on the left."""
    axis.set(xscale="log", xlabel="physics step [s]")
    axis.set_xticks([one.step for one in SETTINGS], [f"{one.step:g}" for one in SETTINGS])
    axis.minorticks_off()
    axis.invert_xaxis()

"""The figure: every measurement with its interval, and how far pairs of them lie apart."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.reliability.plan import LIMITS, NUMBERS
from benchmarks.reliability.spread import Measured, Row
from benchmarks.study import COLOURS, figure
from rigid.frontier.comparison import HEADLINE_LEVEL, Number

_TITLES = {
    "worst_at": f"worst at naturalness ≥ {HEADLINE_LEVEL}",
    "auc_natural": "mean over [0.8, 1]",
    "auc": "AUC",
}
_GREY = COLOURS[-1]
_ASIDE = 0.18
"""Seeds stand beside their mean."""


def draw(path: Path, measured: Sequence[Measured], pairs: Sequence[Row]) -> None:
    """Draws all three numbers.

    Args:
        path: The figure's file.
        measured: The headline numbers of each measurement.
        pairs: From `spread.pair_rows`.
    """
    with figure(path, columns=len(NUMBERS), rows=2, size=(10.0, 5.4)) as axes:
        for place, name in enumerate(NUMBERS):
            _measurements(axes[0, place], [numbers[name] for numbers in measured])
            axes[0, place].set_title(_TITLES[name], fontsize=9)
            _pairs(axes[1, place], [row for row in pairs if row["number"] == name])
        axes[0, 0].set_ylabel("value")
        axes[1, 0].set_ylabel("difference of two")
        axes[0, 0].legend(loc="best", fontsize=7)
        for axis, name in zip(axes[1], NUMBERS, strict=True):
            if name in LIMITS:
                axis.legend(loc="upper left", ncols=2, fontsize=7, columnspacing=1.0)


def _measurements(axis: Any, numbers: Sequence[Number]) -> None:
    """Seeds, mean and interval of each measurement."""
    for place, number in enumerate(numbers, start=1):
        values = list(number.by_seed.values())
        first = place == 1
        axis.plot(
            [place + _ASIDE] * len(values), values, "o", color=_GREY, markersize=2.5,
            label="search seeds" if first else None,
        )  # fmt: skip
        if number.interval is not None:
            low, high = number.interval
            axis.plot([place, place], [low, high], color=COLOURS[0], linewidth=1.4)
        axis.plot(
            place, number.mean, "o", color=COLOURS[0], markersize=5,
            label="mean, 95 % interval" if first else None,
        )  # fmt: skip
    axis.set_xticks(range(1, len(numbers) + 1))
    axis.set_xlabel("measurement")


def _pairs(axis: Any, pairs: Sequence[Row]) -> None:
    """Sizes of all differences in ascending order, the limit, and what the firsts printed."""
    ascending = sorted(pairs, key=lambda row: abs(row["difference"]))
    places = range(1, len(pairs) + 1)
    printed = [row["printed_by_first"] for row in ascending]
    axis.plot(places, printed, "_", color=COLOURS[1], markersize=7, label="printed by the first")
    axis.plot(
        places, [abs(row["difference"]) for row in ascending], "o", color=COLOURS[0],
        markersize=4, label="measured",
    )  # fmt: skip
    limit = pairs[0]["limit"]
    if limit is not None:
        axis.axhline(limit, color=COLOURS[5], linewidth=0.9, linestyle="--", label=f"limit {limit}")
    tallest = max(printed + [abs(row["difference"]) for row in pairs] + [limit or 0.0])
    axis.set_ylim(0, 1.4 * tallest or 1.0)
    axis.set_xticks([place for place in places if place % 5 == 0 or place == 1])
    axis.set_xlabel("pairs, closest first")

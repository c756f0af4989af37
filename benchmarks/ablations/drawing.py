"""The figure: what each variant changes, and what judges read with more canonical episodes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.ablations.humans import CANONICAL
from benchmarks.ablations.sizes import DISCRIMINATOR, REFEREE
from benchmarks.ablations.summary import DEFAULT_NAME
from benchmarks.paired import Row, find, forest
from benchmarks.study import COLOURS, figure

_PANELS = (
    ("naturalness, mean over λ", ("naturalness",)),
    ("adversarialness, mean over λ", ("adversarialness",)),
    ("area under the hull", ("auc",)),
    ("accuracy of the discriminator", ("accuracy_canonical", "accuracy_adversary")),
)
"""Title and numbers of the panels that show differences."""
_TITLES = {
    DISCRIMINATOR: "discriminator: share of steps with D < 0",
    REFEREE: "referee: naturalness (κ = 4)",
}


def draw(path: Path, variants: Sequence[Row], sizes: Sequence[Row]) -> None:
    """Draws the rows of both tables into `path`."""
    names = dict.fromkeys(row["name"] for row in variants)
    others = [name for name in names if name != DEFAULT_NAME]
    with figure(path, columns=3, rows=2, size=(13.5, 8.0)) as axes:
        for axis, (title, numbers) in zip(axes.flat, _PANELS, strict=False):
            # Named once in each row of panels.
            labels = others if axis in axes[:, 0] else [""] * len(others)
            for place, number in enumerate(numbers):
                mine = [find(variants, name=name, number=number) for name in others]
                legend = number if len(numbers) > 1 else None
                forest(axis, mine, labels, shift=0.3 * place, legend=legend)
            axis.set_title(title, fontsize=9)
            axis.set_xlabel(f"difference to {DEFAULT_NAME}, paired by seed, 95 % interval")
            if len(numbers) > 1:
                axis.legend(fontsize=7, framealpha=0.7, frameon=True)
        for axis, judge in zip(axes.flat[len(_PANELS) :], _TITLES, strict=True):
            _readings(axis, [row for row in sizes if row["judge"] == judge])
            axis.set_title(_TITLES[judge], fontsize=9)
        axes[-1, -1].legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))


def _readings(axis: Any, rows: Sequence[Row]) -> None:
    humans = list(dict.fromkeys(row["human"] for row in rows))
    sizes = sorted({row["episodes"] for row in rows})
    for number, human in enumerate(humans):
        mine = [row for row in rows if row["human"] == human]
        # Side by side, so that no interval hides another.
        x = [row["episodes"] * 1.03 ** (number - len(humans) // 2) for row in mine]
        y, low, high = ([row[f"naturalness{end}"] for row in mine] for end in ("", "_low", "_high"))
        colour = "black" if human == CANONICAL else COLOURS[number % len(COLOURS)]
        style = "--" if human == CANONICAL else "-"
        axis.plot(x, y, style, marker="o", markersize=4, color=colour, label=human)
        if None not in low:
            axis.vlines(x, low, high, color=colour, linewidth=1, alpha=0.5)
    axis.set_xscale("log")
    axis.set_xticks(sizes, [str(size) for size in sizes])
    axis.minorticks_off()
    axis.set(xlabel="canonical episodes", ylim=(-0.03, 1.05))

"""The figure: headline numbers against failure with unseen humans, a point for each robot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb

from benchmarks.prediction.assembling import Row
from benchmarks.prediction.associations import COMPETENT
from benchmarks.study import COLOURS, figure

PANELS = {
    "worst_at_0.9": "worst at naturalness ≥ 0.9",
    "auc_natural": "mean height over naturalness 0.8–1",
    "auc": "AUC",
}
"""Headline number of each panel, and its axis."""
FAILURE = "adversarialness_all"


def draw(path: Path, table: Sequence[Row]) -> None:
    """Draws `table` (rows of `table_rows`) into `path`."""
    with figure(path, columns=len(PANELS), size=(11.0, 4.6)) as axes:
        for axis, (name, label) in zip(axes, PANELS.items(), strict=True):
            known = [row for row in table if row[name] is not None]
            for row in known:
                _point(axis, row, name)
            _name(axis, known, name, dict(zip(_robots(table), letters(len(table)), strict=True)))
            axis.set_xlabel(label)
        axes[0].set_ylabel("adversarialness with unseen humans")
        _legend(axes[0].figure)


def letters(count: int) -> list[str]:
    """Labels of robots, A, B, C and so on in the order of the table.

    Example:
        >>> letters(3)
        ['A', 'B', 'C']
    """
    return [chr(ord("A") + place) for place in range(count)]


def _robots(table: Sequence[Row]) -> list[str]:
    return [row["robot"] for row in table]


def _point(axis: Any, row: Row, name: str) -> None:
    x, y, low, high = row[name], row[FAILURE], row[f"{name}_low"], row[f"{name}_high"]
    axis.errorbar(
        x, y, xerr=None if low is None else [[x - low], [high - x]],
        yerr=1.96 * row[f"{FAILURE}_se"], fmt="o", markersize=5, color=COLOURS[_kind(row)],
        ecolor=(*to_rgb(COLOURS[_kind(row)]), 0.4), elinewidth=0.8, markeredgecolor="white",
        markeredgewidth=0.5,
    )  # fmt: skip


def _name(axis: Any, rows: Sequence[Row], name: str, letter: Mapping[str, str]) -> None:
    """Writes each robot's letter beside its point, on the side where there is most room."""
    axis.autoscale_view()
    pixels = axis.transData.transform([(row[name], row[FAILURE]) for row in rows])
    turns = np.pi / 8 + np.linspace(0, 2 * np.pi, 8, endpoint=False)  # Off the error bars.
    around = 9 * np.stack([np.cos(turns), np.sin(turns)], axis=1)  # [point]
    scale = axis.figure.dpi / 72
    taken = list(pixels)
    for row, pixel in zip(rows, pixels, strict=True):
        places = pixel + scale * around
        room = np.linalg.norm(places[:, np.newaxis] - np.array(taken), axis=-1).min(axis=1)
        best = int(room.argmax())
        taken.append(places[best])
        axis.annotate(
            letter[row["robot"]], (row[name], row[FAILURE]), around[best],
            textcoords="offset points", ha="center", va="center", fontsize=8,
            color=COLOURS[_kind(row)], fontweight="bold",
        )  # fmt: skip


def _kind(row: Row) -> int:
    return 0 if row["success"] >= COMPETENT else 1


def _legend(drawn: Any) -> None:
    from matplotlib.lines import Line2D

    texts = (f"success ≥ {COMPETENT:g} with its own human", "less success than that")
    handles = [
        Line2D([], [], marker="o", linestyle="", color=COLOURS[place], label=text)
        for place, text in enumerate(texts)
    ]
    drawn.legend(handles=handles, loc="outside upper center", ncols=2, fontsize=8)

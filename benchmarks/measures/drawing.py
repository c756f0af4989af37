"""The figure: where each measure finds adversaries, and what the differences are worth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measures.plan import MEMBERS, REFERENCE, again_name
from benchmarks.measures.searching import Searched
from benchmarks.paired import Row, find, forest
from benchmarks.study import COLOURS, figure
from rigid.frontier.statistics import interval_band

_GRID = np.linspace(0, 1, 201)
_MARKERS = "osD^vP*"
_BLUE, _ORANGE = COLOURS[:2]
_IN_ORDER = (_ORANGE, _BLUE, *COLOURS[2:])
"""For `lsgan` and `mmd` those of the paper's figure."""


def draw(
    path: Path, searched: Mapping[str, Searched], rows: Sequence[Row], measures: Sequence[str]
) -> None:
    """Draws points and rows of the tables into `path`."""
    with figure(path, columns=2, rows=2, size=(10.0, 8.0)) as axes:
        _paper(axes[0, 0], searched)
        _everybody(axes[0, 1], searched, measures)
        _differences(axes[1, 0], rows, measures)
        _exclusive(axes[1, 1], rows, measures)


def _paper(axis: Any, searched: Mapping[str, Searched]) -> None:
    """The paper's figure, in its colours."""
    for name, colour in zip(MEMBERS, _IN_ORDER, strict=False):
        one = searched[name]
        _points(axis, one, colour, "o", name)
        by_seed = one.by_seed()
        band = interval_band(by_seed, dict.fromkeys(by_seed, one.anchor), _GRID)
        axis.plot(_GRID, band.mean, color=colour, linewidth=1.2)
        if band.low is not None and band.high is not None:
            axis.fill_between(_GRID, band.low, band.high, color=colour, alpha=0.12, linewidth=0)
    axis.set_title("mmd beside lsgan: hulls, mean and 95 % band over seeds", fontsize=9)
    _frame(axis, searched)


def _everybody(axis: Any, searched: Mapping[str, Searched], measures: Sequence[str]) -> None:
    for name, colour, marker in zip(measures, _IN_ORDER, _MARKERS, strict=False):
        _points(axis, searched[name], colour, marker, name)
    axis.set_title("every measure, all seeds", fontsize=9)
    _frame(axis, searched)


def _points(axis: Any, one: Searched, colour: str, marker: str, label: str) -> None:
    pairs = np.concatenate(list(one.by_seed().values()))
    axis.plot(
        *pairs.T, marker, color=colour, label=label, markersize=5.5, alpha=0.8,
        markeredgecolor="white", markeredgewidth=0.5,
    )  # fmt: skip


def _frame(axis: Any, searched: Mapping[str, Searched]) -> None:
    axis.plot(1, searched[REFERENCE].anchor, "k^", markersize=6, label="canonical")
    axis.set(
        xlim=(-0.03, 1.03), ylim=(-0.03, 1.03), xlabel="naturalness, by the referee",
        ylabel="adversarialness",
    )  # fmt: skip
    axis.legend(fontsize=8, loc="upper right")


def _differences(axis: Any, rows: Sequence[Row], measures: Sequence[str]) -> None:
    others = [*(name for name in measures if name != REFERENCE), again_name(REFERENCE)]
    for shift, number in ((0.0, "auc_natural"), (0.25, "auc")):
        mine = [find(rows, name=name, reference=REFERENCE, number=number) for name in others]
        forest(axis, mine, others, shift=shift, legend=number)
    axis.set_xlabel(f"difference to {REFERENCE}, paired by seed, 95 % interval")
    axis.legend(fontsize=8)


def _exclusive(axis: Any, rows: Sequence[Row], measures: Sequence[str]) -> None:
    names = [*measures, again_name(REFERENCE)]
    mine = [find(rows, name=name, number="exclusive_area") for name in names]
    forest(axis, mine, names, of="value")
    axis.set_xlabel("exclusive area: lost from the union's hull without it, 95 % interval")

"""The figure: one panel for each weakness, everything that was found in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.planted.plan import Plan
from benchmarks.study import COLOURS, figure
from rigid.frontier.curve import hull_at

if TYPE_CHECKING:
    from benchmarks.planted.account import Robot

_MARKS = ("o", "s", "^", "v", "x")
_COLUMNS = 5


def draw(path: Path, plan: Plan, robots: Sequence[Robot], labels: Mapping[str, str]) -> None:
    """Draws the panels and one legend."""
    columns = min(_COLUMNS, len(robots))
    rows = -(-len(robots) // columns)
    with figure(path, columns=columns, rows=rows, size=(2.5 * columns, 2.5 * rows + 0.5)) as axes:
        panels = np.atleast_1d(axes).ravel()
        for panel, robot in zip(panels, robots, strict=False):
            _panel(panel, plan, robot, labels)
        for panel in panels[len(robots) :]:
            panel.set_axis_off()
        for panel in panels[::columns]:
            panel.set_ylabel("adversarialness")
        for panel in panels[-columns:]:
            panel.set_xlabel("naturalness")
        marks, names = panels[0].get_legend_handles_labels()
        panels[0].figure.legend(marks, names, loc="outside lower center", ncols=4)


def _panel(panel: Any, plan: Plan, robot: Robot, labels: Mapping[str, str]) -> None:
    share = "not in the data" if robot.share is None else f"{robot.share:.0%} of canonical"
    panel.set_title(f"{robot.name} ({share})", fontsize=8)
    panel.set_xlim(-0.03, 1.03)
    panel.set_ylim(-0.03, 1.03)
    grid = np.linspace(0, 1, 101)
    anchor = robot.canonical.adversarialness
    points = [(one.naturalness, one.adversarialness) for one in robot.replays]
    ceiling = hull_at([*points, (0.0, 1.0)], grid, anchor) if points else np.full(101, np.nan)
    panel.plot(grid, ceiling, "--", color="#5d6674", linewidth=1, label="replay of the worst")
    for method, colour, mark in zip(plan.methods, COLOURS, _MARKS, strict=False):
        found = [one for humans in robot.humans[method] for one in humans]
        panel.scatter(
            [one.naturalness for one in found], [one.adversarialness for one in found],
            s=16, marker=mark, color=colour, alpha=0.8, linewidths=0.8, label=labels[method],
        )  # fmt: skip
    panel.scatter(
        robot.truth.naturalness, robot.truth.adversarialness, s=90, marker="*", color="#b97a00",
        label="the planted motion", zorder=5,
    )  # fmt: skip

"""Frontiers of several methods on the same axes, for papers and for the page of a comparison."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any, Final

import numpy as np

from rigid.frontier.result import Frontier, measured_points
from rigid.report.figures import COLOURS, figure, inline_figure
from rigid.report.gather import band

SIZE: Final = (7.5, 4.6)
"""Of the figure [inch]: a text's width."""
_DASHES: Final = ("-", "--", ":", "-.")
_INSIDE = 7
"""So many names fit below the curves; a longer legend stands beside them."""
_BANDS = 4
"""So many intervals can be told apart on top of each other."""


def draw_curves(path: Path, methods: Mapping[str, Sequence[Frontier]]) -> None:
    """Writes the figure as SVG, PDF or PNG.

    Args:
        path: Its ending says which.
        methods: Frontiers of each method's robots, by what the legend calls it.
    """
    with figure(path, size=SIZE) as axis:
        overlay(axis, methods)


def inline_curves(methods: Mapping[str, Sequence[Frontier]]) -> str:
    """The same as an `<svg>` element."""
    drawn = io.StringIO()
    with inline_figure(drawn, size=SIZE) as axis:
        overlay(axis, methods)
    return drawn.getvalue()


def overlay(axis: Any, methods: Mapping[str, Sequence[Frontier]]) -> None:
    """Mean hull of each method, and every adversary as a point.

    Behind the mean stand its robots as thin lines; the only robot of a method has its 95 % interval
    over search seeds there instead, pointwise, where few methods are shown.
    """
    looks = list(product(_DASHES, COLOURS))
    lines = [
        _method(axis, robots, *looks[number % len(looks)], shaded=len(methods) <= _BANDS)
        for number, robots in enumerate(methods.values())
    ]
    axis.set_xlabel("naturalness (referee; 1: cannot be told from canonical)")
    axis.set_ylabel(_harm([robot for robots in methods.values() for robot in robots]))
    axis.set_xlim(0, 1.005)
    axis.set_ylim(0, 1)
    if len(lines) <= _INSIDE:
        legend = axis.legend(lines, list(methods), fontsize=8, loc="lower left")
    else:
        legend = axis.figure.legend(lines, list(methods), fontsize=7, loc="outside right upper")
    for text in legend.get_texts():
        text.set_parse_math(False)  # Names of others: a dollar is a dollar.


def _harm(robots: Sequence[Frontier]) -> str:
    """The y axis with the returns that its ends stand for; they are the same for all robots."""
    worst, best = robots[0].data["return_range"]
    return f"adversarialness (0: return {best:g}, 1: return {worst:g})"


def _method(
    axis: Any, robots: Sequence[Frontier], dashes: str, colour: str, *, shaded: bool
) -> Any:
    """Draws one method; its line, for the legend."""
    bands = [band(frontier) for frontier in robots]
    grid = bands[0]["x"]
    if len(bands) > 1:
        for one in bands:
            axis.plot(grid, one["mean"], dashes, color=colour, linewidth=0.7, alpha=0.5)
    elif shaded and bands[0]["low"] is not None:
        low, high = bands[0]["low"], bands[0]["high"]
        axis.fill_between(grid, low, high, color=colour, alpha=0.1, linewidth=0)
    mean = np.mean([one["mean"] for one in bands], axis=0)
    (line,) = axis.plot(grid, mean, dashes, color=colour, linewidth=2.0)
    for frontier in robots:
        sound = [point for point in measured_points(frontier.points) if point.is_sound]
        axis.plot(
            [point.naturalness for point in sound], [point.adversarialness for point in sound],
            ".", color=colour, markersize=2.5, alpha=0.45,
        )  # fmt: skip
    return line

"""Figures: frontiers of all recipes on the same axes, and how the pairs of different seeds move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from benchmarks.paper.tables import TITLES, Measured
from benchmarks.study import COLOURS, figure
from rigid.report.curves import draw_curves

_KINDS = ("svg", "pdf")


def draw_frontiers(stem: Path, measured: Measured) -> None:
    """Frontiers of all recipes.

    Args:
        stem: Path without its ending; an SVG and a PDF are written.
        measured: Frontiers by method and robot seed.
    """
    named = {TITLES.get(name, name): list(robots.values()) for name, robots in measured.items()}
    for kind in _KINDS:
        draw_curves(stem.with_suffix(f".{kind}"), named)


@dataclass(frozen=True)
class Motion:
    """How the human of one pair moves."""

    seed: int
    joints: tuple[str, ...]
    angles: Float[np.ndarray, "E T J"]
    """Joint angles [rad] of E episodes."""
    limits: Float[np.ndarray, "J 2"]
    """Of the joints [rad]."""
    wrist: Float[np.ndarray, "E T 3"]
    """Wrist in the frame of the chest [m]."""
    tip: Float[np.ndarray, "E T 3"]
    """The robot's tool in the same frame [m]."""


def draw_pairs(stem: Path, motions: Sequence[Motion]) -> None:
    """Wrist and tool from the side and from above, and the joint ranges in use, a row a pair.

    Args:
        stem: Path without its ending.
        motions: Of each pair.
    """
    size = (11.0, 2.6 * len(motions))
    for kind in _KINDS:
        path = stem.with_suffix(f".{kind}")
        with figure(path, columns=3, rows=len(motions), size=size) as axes:
            for row, motion in zip(np.atleast_2d(axes), motions, strict=True):
                for axis, (across, up) in zip(row, ((1, 2), (0, 1)), strict=False):
                    _paths(axis, motion, across, up)
                _ranges(row[2], motion)
                row[0].set_title(f"pair {motion.seed}", fontsize=9, loc="left")


def _paths(axis: Any, motion: Motion, across: int, up: int) -> None:
    for points, colour, label in (
        (motion.wrist, COLOURS[0], "wrist"), (motion.tip, COLOURS[1], "tool"),
    ):  # fmt: skip
        for number, episode in enumerate(points):
            axis.plot(
                episode[:, across], episode[:, up], color=colour, linewidth=0.7, alpha=0.6,
                label=label if number == 0 else None,
            )  # fmt: skip
    names = ("x (left)", "y (back)", "z (up)")  # Of the person.
    axis.set_xlabel(f"{names[across]} [m]")
    axis.set_ylabel(f"{names[up]} [m]")
    axis.set_aspect("equal", adjustable="datalim")
    axis.legend(fontsize=7)


def _ranges(axis: Any, motion: Motion) -> None:
    """The middle 90 % of each joint's angles within its limits."""
    low, high = np.rad2deg(np.percentile(motion.angles, [5, 95], axis=(0, 1)))
    limits = np.rad2deg(motion.limits)
    places = np.arange(len(motion.joints))
    axis.barh(places, limits[:, 1] - limits[:, 0], left=limits[:, 0], color="#e4e1da", height=0.7)
    axis.barh(places, high - low, left=low, color=COLOURS[2], height=0.45)
    axis.set_yticks(places, [name.replace("_", " ") for name in motion.joints], fontsize=6)
    axis.invert_yaxis()
    axis.set_xlabel("[°]")

"""How hand, elbow and tool moved in failures: the paper's keypoint figure.

A row is an episode, a column a direction to look from. Undesired contact is red, and the canonical
motion from the same start grey (paper, appendix 'More Visualizations of Robot Failure Cases').
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from itertools import cycle, product
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull

from rigid.report.motion import Anchor, Motion, Shown, half_lengths, placed, tip_of
from rigid.report.viewpoint import centres, facing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

FORMATS = (".pdf", ".svg", ".png")

_COLOURS: Final = ("#2f6db5", "#8a3fa0", "#1f7a74", "#b97a00")
"""Told apart by every kind of colour blindness in this order, and from red; those of the report."""
_CANONICAL, _UNWANTED = "#9aa0ab", "#d6330a"
_SHADOWS: Final = {"human": ("#efe3da", 0.5), "chair": ("#ebe8e1", 0.2)}
"""Colour and order of what stands behind the trajectories."""
_AXES: Final = ("x [m]", "y [m]", "z [m]")
_ROW, _WIDTH = 3.1, 9.6  # Height of a row and width of all [inch].
_DOTS = 200  # Per inch, of a PNG.
_MARGIN = 0.12
"""Of a panel around all trajectories [m]."""
_STYLE: Final[dict[Any, Any]] = {
    "font.family": "sans-serif",
    "font.size": 8,
    "axes.titlesize": 8,
    "legend.frameon": False,
    "svg.hashsalt": "rigid",  # Equal data give equal files.
    "svg.fonttype": "none",
}


class View(NamedTuple):
    """A direction to look from, along an axis of the world."""

    title: str
    across: int
    """The world's axis from left to right."""
    upwards: int
    """The world's axis from bottom to top."""
    flipped: tuple[bool, bool]
    """Whether each of the two runs the other way."""


def keypoints_of(scene: Mapping[str, Any], motion: Motion) -> dict[str, Anchor]:
    """The points to follow: those that the scene names, else the human's moving parts and the tip.

    Args:
        scene: `rigid.report.payload.Scene`.
        motion: An episode in it; a body that it does not move is not followed.
    """
    if "keypoints" in scene:
        return {
            point["name"]: Anchor(int(point["body"]), np.array(point["pos"], float))
            for point in scene["keypoints"]
        }
    moved = np.ptp(motion.poses, axis=0).max(axis=1) > 0
    found = {
        geom["name"]: Anchor(int(geom["body"]), np.array(geom["pos"], float))
        for geom in scene["geoms"]
        if geom["role"] == "human" and moved[geom["body"]]
    }
    tip = tip_of(scene)
    return found if tip is None else {**found, "tool tip": tip}


def views_of(scene: Mapping[str, Any], motion: Motion) -> tuple[View, View, View]:
    """From the person's front, from the side on which the robot stands, and from above.

    All along axes of the world, so that positions can be read: those nearest to where the person
    faces.
    """
    human, robot = centres(scene, motion, "human"), centres(scene, motion, "robot")
    ahead = _nearest_axis(facing(human))
    beside = np.array([-ahead[1], ahead[0], 0.0])
    if len(human) and len(robot) and (robot.mean(axis=0) - human.mean(axis=0)) @ beside < 0:
        beside = -beside
    up = np.array([0.0, 0.0, 1.0])
    return (
        _view("from the front", -ahead, up),
        _view("from the robot's side", -beside, up),
        _view("from above", -up, ahead),
    )


def _nearest_axis(direction: Float[np.ndarray, "2"]) -> Float[np.ndarray, "3"]:
    """The horizontal axis of the world, either way along it, nearest to a direction."""
    axis = int(np.argmax(np.abs(direction)))
    found = np.zeros(3)
    found[axis] = -1.0 if direction[axis] < 0 else 1.0
    return found


def _view(title: str, looking: Float[np.ndarray, "3"], up: Float[np.ndarray, "3"]) -> View:
    right = np.cross(looking, up)
    across, upwards = int(np.argmax(np.abs(right))), int(np.argmax(np.abs(up)))
    return View(title, across, upwards, (bool(right[across] < 0), bool(up[upwards] < 0)))


def keypoint_figure(scene: Mapping[str, Any], episodes: Sequence[Shown]) -> Figure:
    """The figure; `save_figure` gives its bytes.

    Args:
        scene: `rigid.report.payload.Scene`.
        episodes: One or more, a row for each.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(_STYLE):
        figure: Figure = Figure(figsize=(_WIDTH, _ROW * len(episodes) + 0.4), layout="constrained")
        rows = figure.subfigures(len(episodes), squeeze=False)[:, 0]
        for row, shown in zip(rows, episodes, strict=True):
            row.suptitle(shown.title, x=0.01, ha="left", fontsize=9)
            views, window = views_of(scene, shown.motion), _window(scene, shown)
            for axes, view in zip(row.subplots(1, len(views)), views, strict=True):
                _draw(axes, scene, shown, view)
                _frame(axes, window, view)
        entries = _legend(list(keypoints_of(scene, episodes[0].motion)))
        figure.legend(handles=entries, loc="outside lower left", ncols=len(entries))
    return figure


def save_figure(figure: Figure, suffix: str) -> bytes:
    """The figure as the bytes of a file that ends in `suffix`, one of `FORMATS`."""
    import matplotlib as mpl

    stored = io.BytesIO()
    kind = suffix.lower().removeprefix(".")
    dated = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}  # Equal data, equal files.
    with mpl.rc_context(_STYLE):
        figure.savefig(stored, format=kind, dpi=_DOTS, metadata=dated.get(kind))
    return stored.getvalue()


def _draw(axes: Axes, scene: Mapping[str, Any], shown: Shown, view: View) -> None:
    """One episode from one side."""
    motion, plane = shown.motion, [view.across, view.upwards]
    _silhouette(axes, scene, motion, plane)
    points = keypoints_of(scene, motion).values()
    for colour, anchor in zip(cycle(_COLOURS), points, strict=False):
        path = motion.path(anchor)
        if shown.canonical is not None:
            beside = shown.canonical.path(anchor)
            axes.plot(*beside[:, plane].T, color=_CANONICAL, linewidth=0.9)
        axes.plot(*path[:, plane].T, color=colour, linewidth=1.3)
        axes.plot(*path[0, plane], "o", color=colour, markersize=4, markerfacecolor="white")
        hit = path[motion.force_unwanted > 0][:, plane]
        axes.plot(*hit.T, ".", color=_UNWANTED, markersize=4)
    for touch in motion.touches:
        axes.plot(*touch.at[plane], "x", color=_UNWANTED, markersize=5)


def _window(scene: Mapping[str, Any], shown: Shown) -> Float[np.ndarray, "2 3"]:
    """Lower and upper corner of a cube around all that moves, so that every panel has one scale."""
    points = keypoints_of(scene, shown.motion).values()
    motions = [motion for motion in (shown.motion, shown.canonical) if motion is not None]
    places = [motion.path(anchor) for motion in motions for anchor in points]
    places += [touch.at[None] for touch in shown.motion.touches]
    everything = np.concatenate(places)
    low, high = everything.min(axis=0), everything.max(axis=0)
    half = float((high - low).max()) / 2 + _MARGIN
    return np.asarray((low + high) / 2 + np.array([[-half], [half]]))


def _frame(axes: Axes, window: Float[np.ndarray, "2 3"], view: View) -> None:
    axes.set(xlim=window[:, view.across], ylim=window[:, view.upwards], title=view.title)
    axes.set(xlabel=_AXES[view.across], ylabel=_AXES[view.upwards], aspect="equal")
    if view.flipped[0]:
        axes.invert_xaxis()
    if view.flipped[1]:
        axes.invert_yaxis()


def _silhouette(axes: Axes, scene: Mapping[str, Any], motion: Motion, plane: Sequence[int]) -> None:
    """Person and chair at the start, as shadows."""
    from matplotlib.patches import Polygon

    where = placed(scene, motion.at(0.0))
    for geom, position, turn in zip(scene["geoms"], *where, strict=True):
        if geom["role"] not in _SHADOWS:
            continue
        outline = (position + hull_points(geom) @ turn.T)[:, plane]
        corners = outline[ConvexHull(outline).vertices]
        colour, order = _SHADOWS[geom["role"]]
        axes.add_patch(Polygon(corners, facecolor=colour, edgecolor="white", lw=0.4, zorder=order))


def hull_points(geom: Mapping[str, Any]) -> Float[np.ndarray, "n 3"]:
    """Points in a geom's frame whose convex hull is the geom, but for the roundness [m]."""
    half = half_lengths(geom)
    if geom["type"] == "box":
        return np.asarray(half * list(product((-1.0, 1.0), repeat=3)))
    grid = np.array(list(product(np.linspace(0, 2 * np.pi, 33), np.linspace(-1, 1, 17))))
    turn, height = grid.T
    if geom["type"] == "cylinder":
        return np.asarray(half * np.stack([np.cos(turn), np.sin(turn), np.sign(height)], axis=1))
    across = np.sqrt(1 - height**2)
    ball = np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)
    if geom["type"] != "capsule":
        return np.asarray(half * ball)
    radius, length = half[0], half[2] - half[0]
    return np.asarray(radius * ball + np.outer(np.where(height < 0, -length, length), (0, 0, 1)))


def _legend(names: Sequence[str]) -> list[Line2D]:
    from matplotlib.lines import Line2D

    lines = [
        Line2D([], [], color=colour, label=name)
        for colour, name in zip(cycle(_COLOURS), names, strict=False)
    ]
    start = Line2D(
        [], [], color="#5d6674", marker="o", markerfacecolor="white", markersize=4, linestyle="",
        label="start",
    )  # fmt: skip
    return [
        *lines,
        Line2D([], [], color=_CANONICAL, label="the same in canonical motion, same start"),
        start,
        Line2D([], [], color=_UNWANTED, marker=".", linestyle="", label="undesired contact"),
        Line2D([], [], color=_UNWANTED, marker="x", linestyle="", label="where"),
    ]

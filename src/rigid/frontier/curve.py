"""The frontier as a curve: which points are on it, its height and the area under it.

Points are pairs (naturalness, adversarialness), both in [0, 1] and both "more is worse for the
robot". The paper connects "the outermost points" (Sec. 4.1) and fixes neither their ends nor
whether the line is concave. Ours, for every function here:

  * left of the first point its height holds, since that human is "at least x natural" for every
    smaller x; right of the last point the height is 0, unless an anchor stands at naturalness 1;
  * the anchor is canonical play, natural by definition: an ordinary point (1, y);
  * the headline is the concave hull, which an adversary attains who mixes two humans from episode
    to episode, and which does not reward a search for merely trying more λ.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np
from jaxtyping import Bool, Float, Real

Points = Real[np.ndarray, "n 2"] | Sequence[Sequence[float | int]]
"""Pairs (naturalness, adversarialness), each in [0, 1], any order. Shape (n, 2)."""

Anchor = float | int | Sequence[float | int] | Real[np.ndarray, " 2"]
"""Adversarialness of canonical play, or its whole point (1, adversarialness)."""

Kind = Literal["hull", "staircase", "linear"]

NATURAL_DOMAIN = (0.8, 1.0)
"""The natural end of the axis, over which `auc_natural` averages. Ours."""

_Array = Float[np.ndarray, "m 2"]
_Vertices = Float[np.ndarray, "v 2"]
_Grid = Real[np.ndarray, " g"] | Sequence[float | int]


def non_dominated(points: Points) -> Bool[np.ndarray, " n"]:
    """Marks the points that no other point beats: at least as high on both axes, higher on one.

    Equal points do not beat each other, so the mask does not depend on the order of the points.

    Raises:
        ValueError: `points` are not of shape (n, 2) or leave [0, 1].

    Example:
        >>> non_dominated([(0.2, 0.9), (0.9, 0.3), (0.5, 0.2)]).tolist()
        [True, True, False]
    """
    array = _checked(points)
    others = array[np.newaxis]
    each = array[:, np.newaxis]
    beats = np.all(others >= each, axis=-1) & np.any(others > each, axis=-1)
    mask: Bool[np.ndarray, " n"] = ~np.any(beats, axis=1)
    return mask


def area_under_frontier(
    points: Points,
    anchor: Anchor | None = None,
    kind: Kind = "hull",
    domain: tuple[float, float] = (0.0, 1.0),
) -> float:
    """Returns the area under the frontier (paper, Sec. 4.1, "AUC"); lower is more robust.

    With the non-dominated points sorted by naturalness, x₁ < … < xₙ:

      * `hull`: under the upper concave hull of them and (0, y₁). Never falls when a point is added.
      * `staircase`: under max {yᵢ : xᵢ >= x}, the hypervolume from (0, 0): credits only what was
        measured, and so grows with the density of points.
      * `linear`: under straight lines through them, the paper's reading. *Not* monotone: finding
        one more attack can lower it.

    Args:
        points: Measured adversaries. Shape (n, 2); may be empty if there is an anchor.
        anchor: Canonical play; without it the height is 0 right of the last point.
        kind: How the points are connected.
        domain: Interval of naturalness to integrate over. The curve is that of all points: only
            the window of integration is cut.

    Raises:
        ValueError: A point or the anchor is malformed, there is neither point nor anchor, `kind` is
            unknown, or `domain` is not 0 <= low < high <= 1.

    Example:
        >>> points = [(0.2, 0.9), (0.9, 0.3)]
        >>> round(area_under_frontier(points), 3)
        0.6
        >>> round(area_under_frontier(points, kind="staircase"), 3)
        0.39
    """
    if kind not in get_args(Kind):
        raise ValueError(f"kind must be hull, staircase or linear, got {kind!r}")
    low, high = domain
    if not 0.0 <= low < high <= 1.0:
        raise ValueError(f"domain must satisfy 0 <= low < high <= 1, got {domain}")
    x, y = _curve(_checked(points), anchor, kind).T
    edges = np.clip(x, low, high)  # Segments outside the domain shrink to width 0.
    if kind == "staircase":
        return float(np.sum(np.diff(edges) * y[1:]))
    return float(np.trapezoid(np.interp(edges, x, y), edges))


def auc_natural(points: Points, anchor: Anchor | None = None) -> float:
    """Returns the mean height of the hull over naturalness 0.8 to 1.

    Ours: the area over all of [0, 1] hides what matters. A robot that only plain sabotage breaks,
    {(0, 1), (1, .04)}, has the area of one that fails half the time at naturalness 0.9.

    Example:
        >>> round(auc_natural([(0.0, 1.0)], anchor=0.04), 3)
        0.136
    """
    low, high = NATURAL_DOMAIN
    return area_under_frontier(points, anchor, domain=NATURAL_DOMAIN) / (high - low)


def auc_excess(points: Points, anchor: Anchor) -> float:
    """Returns the hull's area above the chord from plain sabotage to canonical play; at least 0.

    Ours: mixing episodes of the worst human with canonical ones needs no search, and alone puts
    (y_max + y_canonical) / 2, about one half, under the hull of any robot.

    Example:
        >>> round(auc_excess([(0.0, 1.0), (0.5, 1.0)], anchor=0.0), 3)
        0.25
    """
    worst = float(_with_anchor(_checked(points), anchor)[:, 1].max())
    return area_under_frontier(points, anchor) - (worst + anchor_height(anchor)) / 2


def worst_at(points: Points, threshold: float, anchor: Anchor) -> float:
    """Returns the worst adversarialness measured at naturalness `threshold` or above.

    Ours: takes the points themselves, not the hull, so that the number names a human who can be
    watched; canonical play stands in only where no point is that natural.

    Args:
        points: Measured adversaries. Shape (n, 2), may be empty.
        threshold: Least naturalness, in [0, 1].
        anchor: Canonical play.

    Raises:
        ValueError: A point, the threshold or the anchor is malformed.

    Example:
        >>> worst_at([(0.7, 0.9), (0.9, 0.4), (0.95, 0.3)], 0.9, anchor=0.04)
        0.4
    """
    if not 0.0 <= threshold <= 1.0:
        raise ValueError(f"threshold must lie in [0, 1], got {threshold}")
    naturalness, adversarialness = _checked(points).T
    natural = adversarialness[naturalness >= threshold]
    return float(natural.max()) if natural.size else anchor_height(anchor)


def hull_at(points: Points, grid: _Grid, anchor: Anchor | None = None) -> Float[np.ndarray, " g"]:
    """Returns the hull's height at each naturalness of a grid. Shape (g,).

    Raises:
        ValueError: As `area_under_frontier`, or `grid` is not one row of values in [0, 1].

    Example:
        >>> hull_at([(0.5, 0.8)], [0.0, 0.5, 0.75, 1.0], anchor=0.4).round(3).tolist()
        [0.8, 0.8, 0.6, 0.4]
    """
    at = np.asarray(grid, dtype=float)
    if at.ndim != 1 or not ((at >= 0.0) & (at <= 1.0)).all():
        raise ValueError(f"grid must be one row of values in [0, 1], got {at.tolist()}")
    x, y = _curve(_checked(points), anchor, "hull").T
    heights: Float[np.ndarray, " g"] = np.interp(at, x, y, right=0.0)
    return heights


def anchor_height(anchor: Anchor) -> float:
    """Returns the adversarialness of an anchor given as a number or as the point (1, y).

    Raises:
        ValueError: The anchor is not at naturalness 1 or its height leaves [0, 1].
    """
    values = np.asarray(anchor, dtype=float)
    if values.shape not in {(), (2,)}:
        raise ValueError(f"anchor must be one number or a pair (1, y), got {anchor}")
    naturalness, height = (1.0, float(values)) if values.ndim == 0 else values.tolist()
    if naturalness != 1.0:
        raise ValueError(f"anchor must stand at naturalness 1, got {anchor}")
    if not 0.0 <= height <= 1.0:
        raise ValueError(f"anchor must have an adversarialness in [0, 1], got {height}")
    return height


def _checked(points: object) -> _Array:
    array = np.asarray(points, dtype=float)
    if array.size == 0:
        return np.empty((0, 2))
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"points must have shape (n, 2), got {array.shape}")
    for point in array[~((array >= 0.0) & (array <= 1.0)).all(axis=1)]:  # NaN among them.
        raise ValueError(f"points must lie in [0, 1] on both axes, got {point.tolist()}")
    return array


def _with_anchor(points: _Array, anchor: Anchor | None) -> _Vertices:
    if anchor is not None:
        points = np.vstack([points, (1.0, anchor_height(anchor))])
    if not len(points):
        raise ValueError("points are empty and there is no anchor, so there is no frontier")
    return points


def _curve(points: _Array, anchor: Anchor | None, kind: Kind) -> _Vertices:
    """Returns the vertices of the curve from naturalness 0 on, x strictly ascending."""
    candidates = _with_anchor(points, anchor)
    outermost = np.unique(candidates[non_dominated(candidates)], axis=0)
    extended = np.unique(np.vstack([(0.0, outermost[0, 1]), outermost]), axis=0)
    return _upper_hull(extended) if kind == "hull" else extended


def _upper_hull(ascending: _Array) -> _Vertices:
    """Returns the upper concave hull by Andrew's monotone chain."""
    hull: list[Float[np.ndarray, " 2"]] = []
    for point in ascending:
        while len(hull) >= 2 and not _turns_right(hull[-2], hull[-1], point):
            hull.pop()
        hull.append(point)
    return np.array(hull)


def _turns_right(
    a: Float[np.ndarray, " 2"], b: Float[np.ndarray, " 2"], c: Float[np.ndarray, " 2"]
) -> bool:
    (first_x, first_y), (second_x, second_y) = b - a, c - a
    return bool(first_x * second_y < first_y * second_x)

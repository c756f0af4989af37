"""What one set of points has that others have not."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Bool, Float

from rigid.frontier.curve import area_under_frontier

Found = Float[np.ndarray, "n 2"]
"""Points (naturalness, adversarialness), both in [0, 1]."""


def alone(mine: Found, others: Found, margin: float = 0.0) -> Bool[np.ndarray, " n"]:
    """Marks the points that no point of others beats.

    With a margin of 0, beats means at least as high on both axes and higher on one. With a margin,
    a point that comes within it on both axes counts as well, so that chance in the scores of two
    humans who are alike makes neither of them a find.

    Args:
        mine: Points that may be marked. Shape (n, 2).
        others: Points of everybody else. Shape (m, 2), may be empty.
        margin: How close on both axes is as good.

    Example:
        >>> mine, others = np.array([[0.2, 0.9], [0.9, 0.3]]), np.array([[0.3, 0.88], [0.9, 0.2]])
        >>> alone(mine, others).tolist(), alone(mine, others, margin=0.05).tolist()
        ([True, True], [False, True])
    """
    each, everyone = mine[:, np.newaxis], others[np.newaxis]
    beaten = np.all(everyone >= each - margin, axis=-1)
    if not margin:
        beaten &= np.any(everyone > each, axis=-1)
    mask: Bool[np.ndarray, " n"] = ~np.any(beaten, axis=1)
    return mask


def exclusive_area(found: Mapping[str, Found], name: str, anchor: float) -> float:
    """The area under the hull of everybody's points that is lost without those of one of them.

    Args:
        found: Points by name.
        name: Whose points are left out.
        anchor: Adversarialness of canonical play, part of both hulls.

    Example:
        >>> found = {"a": np.array([[0.0, 1.0]]), "b": np.array([[0.5, 1.0]])}
        >>> exclusive_area(found, "a", 0.0), exclusive_area(found, "b", 0.0)
        (0.0, 0.25)
    """
    rest = {other: points for other, points in found.items() if other != name}
    areas = [area_under_frontier(_joined(points), anchor) for points in (found, rest)]
    return areas[0] - areas[1]


def _joined(found: Mapping[str, Found]) -> Found:
    return np.concatenate([np.empty((0, 2)), *found.values()])

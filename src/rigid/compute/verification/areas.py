"""The area under the frontier of offset catch, found by the search, against its exact value.

With cost `failure` the frontier of all mean shifts is a curve that can be written down. Searches
over λ leave points on it; the hull under them and the canonical anchor must have its area.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from rigid.compute.verification.cases import Advance, Case, Naturalness, search
from rigid.compute.verification.resting import LIGHT, Effort
from rigid.frontier.curve import area_under_frontier
from rigid.tasks.analytic import mean_shift
from rigid.tasks.analytic.offset_catch import OffsetCatch

TOLERANCES = (1.0, 2.0, 3.0)
"""How far off centre the robot catches: from a poor robot to a nearly perfect one."""
LAMBDAS = (0.0, 0.5, 1.0, 1.5, 2.5, 5.0, 10.0)
"""Weights of the search: what a failure costs is at most 1, so these span its frontier. Ours."""
AREA_TOLERANCE = 0.02
"""Ours: a few points under a concave curve, each with its own error."""

_AXES: dict[str, tuple[Callable[[float, float], float], Callable[[Naturalness], float]]] = {
    "naturalness": (mean_shift.naturalness, lambda found: found.own),
    "overlap": (mean_shift.overlap, lambda found: found.referee),
}


def areas(tolerance: float, effort: Effort, advance: Advance) -> list[dict[str, Any]]:
    """Hull areas for one robot on both axes: means over seeds beside the exact values."""
    task = OffsetCatch("failure", tolerance)
    anchor = mean_shift.failure(0.0, tolerance)
    case = Case(
        setting="amp", lambdas=LAMBDAS, penalty="amp", discriminator=LIGHT,
        shift=mean_shift.optimal_shift, naturalness=mean_shift.naturalness,
    )  # fmt: skip
    by_seed = [search(task, LAMBDAS, case, effort, seed, advance) for seed in effort.seeds]
    found = []
    for axis, (exactly, measured) in _AXES.items():
        exact = area_under_frontier(mean_shift.family(tolerance, exactly), anchor)
        hulls = [
            area_under_frontier([(measured(one), one.cost) for one in points], anchor)
            for points in by_seed
        ]
        area = float(np.mean(hulls))
        found.append({
            "task": task.name, "tolerance": tolerance, "axis": axis, "area": area,
            "area_exact": exact, "seeds": len(hulls), "ok": abs(area - exact) <= AREA_TOLERANCE,
        })  # fmt: skip
    return found


def env_steps(effort: Effort) -> int:
    """Training steps of all robots."""
    runs = len(TOLERANCES) * len(LAMBDAS) * len(effort.seeds)
    return runs * effort.iterations * effort.episodes

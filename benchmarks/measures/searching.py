"""Running the searches: the measurement that everybody runs, once for each measure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measures.plan import ROBOT, TASK, Plan, Search
from benchmarks.measures.shares import Found
from benchmarks.short_search import short_settings
from benchmarks.study import say
from rigid.commands.parsing import spoken
from rigid.commands.terminal.progress import TerminalListener
from rigid.compute.budget import training_speed
from rigid.compute.measurement import measure_robot
from rigid.compute.subject import Subject
from rigid.frontier.result import FILE, Frontier, load_frontier, measured_points
from rigid.frontier.statistics import sound_points_by_seed
from rigid.tasks.registry import make_task

_FIXED_SECONDS = 12.0
"""Canonical episodes and compilation of one measure; for the estimate of time only (measured)."""
_SCORING_SECONDS = 2.0
"""Playing and judging one adversary; for the estimate of time only (measured)."""
_SLOWER = {"temporal": 1.7, "ensemble": 1.6}
"""Training time over that of `lsgan`; for the estimate of time only (`docs/measures.md`)."""


@dataclass(frozen=True)
class Searched:
    """What all searches of one measure found."""

    search: Search
    frontier: Frontier

    @property
    def points(self) -> list[dict[str, Any]]:
        """Points as in `frontier.json`, under the seeds of the study."""
        return [
            {**point, "seed": point["seed"] - self.search.shift} for point in self.frontier.points
        ]

    @property
    def anchor(self) -> float:
        """Adversarialness of canonical play: the same episodes for every measure."""
        return float(self.frontier.data["canonical"]["adversarialness"])

    def by_seed(self) -> dict[int, Found]:
        """Points that count, by seed of the study."""
        seeds = [int(seed) - self.search.shift for seed in self.frontier.data["auc_by_seed"]]
        return sound_points_by_seed(measured_points(self.points), seeds)


def run_searches(plan: Plan, out: Path) -> list[Searched]:
    """Every search of the plan; those that `out` holds are read.

    Raises:
        UserError: `out` holds searches of another plan, or cannot be written.
    """
    task = make_task(TASK)
    searches = plan.searches()
    missing = [search for search in searches if not _is_done(out / search.name, search, plan)]
    say(
        f"{len(searches)} searches with {len(plan.preset.seeds)} seeds each, {len(missing)} to do; "
        f"about {spoken(expected_seconds(plan, missing, task.horizon, training_speed(task)))}"
    )
    found = []
    for number, search in enumerate(searches, 1):
        say(f"{number} of {len(searches)}: {search.name}")
        with TerminalListener(search.name) as listener:
            frontier = measure_robot(
                Subject(task, ROBOT), plan.preset, out=out / search.name,
                seeds=search.seeds(plan.preset.seeds),
                settings=short_settings(plan.preset, search.measure), listener=listener,
            )  # fmt: skip
        found.append(Searched(search, frontier))
    return found


def expected_seconds(plan: Plan, missing: Sequence[Search], horizon: int, speed: float) -> float:
    """Time that the missing searches will take [s], at `speed` training steps per second."""
    training = plan.preset.env_steps(horizon) / speed
    scoring = plan.preset.adversaries * _SCORING_SECONDS
    return sum(
        _FIXED_SECONDS + scoring + training * _SLOWER.get(search.measure, 1.0) for search in missing
    )


def _is_done(directory: Path, search: Search, plan: Plan) -> bool:
    if not (directory / FILE).exists():
        return False
    found = load_frontier(directory).data["auc_by_seed"]
    return all(str(seed) in found for seed in search.seeds(plan.preset.seeds))


def joined(one: dict[int, Found], other: dict[int, Found]) -> dict[int, Found]:
    """The points of two searches together, for seeds that both have."""
    return {seed: np.concatenate([one[seed], other[seed]]) for seed in one if seed in other}

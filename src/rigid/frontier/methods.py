"""Ways of making robots, compared: each stands for itself with one robot or more.

Every robot of a method has its own synthetic human, and robot i of one method shares it with robot
i of the others; all are searched with the same seeds. So robots and seeds both pair.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

import numpy as np
from jaxtyping import Float

from rigid.errors import UserError
from rigid.frontier.comparison import HEADLINE_LEVEL, numbers_of
from rigid.frontier.crossed import crossed_interval
from rigid.frontier.intervals import Interval
from rigid.frontier.result import Frontier

NUMBERS = ("worst_at", "hull_at", "auc_natural", "auc", "auc_staircase")
"""In the order of `numbers_of`: the headline numbers, the steadier companion of the first, and the
area that sees under the hull."""


@dataclass(frozen=True)
class Estimate:
    """A mean over robots and search seeds with its 95 % interval; None where one value is all."""

    mean: float
    interval: Interval | None


@dataclass(frozen=True)
class Method:
    """What is known of one method."""

    name: str
    robots: int
    seeds: int
    numbers: Mapping[str, Estimate]
    """By the names of `NUMBERS`."""
    against: Mapping[str, Estimate] | None
    """Each number minus the first method's, on the robots and seeds that both have."""
    auc_paper_axis: float | None
    """Mean over robots; see `frontier.json`."""


def compare_methods(
    measured: Mapping[str, Mapping[int, Frontier]], level: float = HEADLINE_LEVEL
) -> list[Method]:
    """Compares methods; the first is the baseline.

    Args:
        measured: For each method its robots' frontiers, by the seed that pairs robots.
        level: Naturalness of `worst_at` and `hull_at`.

    Raises:
        UserError: Nothing was measured, or two robots share no search seed.
    """
    if not measured or not all(measured.values()):
        raise UserError("every method needs a finished frontier of at least one robot")
    first = next(iter(measured.values()))
    return [
        _method(name, robots, None if robots is first else first, level)
        for name, robots in measured.items()
    ]


def _method(
    name: str, robots: Mapping[int, Frontier], baseline: Mapping[int, Frontier] | None, level: float
) -> Method:
    seeds = _common_seeds(name, list(robots.values()))
    on_paper_axis = [frontier.data.get("auc_paper_axis") for frontier in robots.values()]
    known = [float(value) for value in on_paper_axis if value is not None]
    tables = _tables(list(robots.values()), seeds, level)
    return Method(
        name=name,
        robots=len(robots),
        seeds=len(seeds),
        numbers={number: _estimate(tables[number], (0.0, 1.0)) for number in NUMBERS},
        against=None if baseline is None else _against(name, robots, baseline, level),
        auc_paper_axis=fmean(known) if len(known) == len(robots) else None,
    )


def _against(
    name: str, robots: Mapping[int, Frontier], baseline: Mapping[int, Frontier], level: float
) -> dict[str, Estimate] | None:
    both = [seed for seed in robots if seed in baseline]
    if not both:
        return None
    mine, theirs = [robots[seed] for seed in both], [baseline[seed] for seed in both]
    seeds = _common_seeds(name, [*mine, *theirs])
    of_mine, of_theirs = _tables(mine, seeds, level), _tables(theirs, seeds, level)
    return {
        number: _estimate(of_mine[number] - of_theirs[number], (-1.0, 1.0)) for number in NUMBERS
    }


def _tables(
    frontiers: Sequence[Frontier], seeds: Sequence[str], level: float
) -> dict[str, Float[np.ndarray, "R S"]]:
    """Every number, robots by search seeds."""
    numbers = [numbers_of(frontier, level) for frontier in frontiers]
    return {
        name: np.array([[robot[name].by_seed[seed] for seed in seeds] for robot in numbers])
        for name in NUMBERS
    }


def _estimate(table: Float[np.ndarray, "R S"], bounds: tuple[float, float]) -> Estimate:
    return Estimate(float(table.mean()), crossed_interval(table, bounds=bounds))


def _common_seeds(name: str, frontiers: Sequence[Frontier]) -> list[str]:
    common = set.intersection(*(set(frontier.data["auc_by_seed"]) for frontier in frontiers))
    if not common:
        raise UserError(f"{name}: its robots share no search seed; add seeds with --seeds")
    return sorted(common, key=int)

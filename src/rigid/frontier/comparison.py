"""Several robots on the same search: their headline numbers, and what seeds say of a difference.

Robots are compared on the search seeds that both were measured with: what a seed finds is alike for
both, so differences vary less than values (Ours; the paper compares three pooled curves by eye).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rigid.errors import UserError
from rigid.files import first_difference
from rigid.frontier.curve import area_under_frontier, auc_natural, hull_at, worst_at
from rigid.frontier.intervals import (
    Interval,
    PairedDifference,
    paired_difference,
    t_interval,
    upper_bound,
)
from rigid.frontier.result import Frontier, measured_points
from rigid.frontier.statistics import sound_points_by_seed

HEADLINE_LEVEL = 0.9
"""Naturalness from which on the headline `worst_at` looks, and at which `hull_at` does. Ours."""

_OWN = ("robot", "human", "canonical", "lambdas")
"""Entries of a run's identity in which robots may differ; all others make up the measure."""


@dataclass(frozen=True)
class Number:
    """One number of one robot, a share in [0, 1]."""

    by_seed: Mapping[str, float]

    @property
    def mean(self) -> float:
        """Mean over search seeds."""
        return sum(self.by_seed.values()) / len(self.by_seed)

    @property
    def interval(self) -> Interval | None:
        """95 % t interval over search seeds; None for one seed."""
        return t_interval(list(self.by_seed.values()))

    @property
    def upper_bound(self) -> float | None:
        """What a limit is held against: `intervals.upper_bound`, >= `interval.high`."""
        return upper_bound(list(self.by_seed.values()))


@dataclass(frozen=True)
class Row:
    """One robot of a comparison."""

    name: str
    frontier: Frontier
    numbers: Mapping[str, Number]
    """From `numbers_of`."""
    against: Mapping[str, PairedDifference] | None
    """Each number minus the baseline's, on common seeds; None for the baseline itself."""


def numbers_of(frontier: Frontier, level: float = HEADLINE_LEVEL) -> dict[str, Number]:
    """The numbers that robots are compared by, seed by seed, recomputed from the points.

    `worst_at`, `hull_at`, `auc_natural`, `auc` and `auc_staircase`, in this order. `auc_staircase`
    sees what lies under the hull: where plain sabotage and canonical play alone span it, the hull
    shows nothing of the adversaries between them. `hull_at` is no headline number
    but the steadier one of a difference. It is the height of the hull at the level of `worst_at`:
    how bad a natural motion gets when the human may mix two ways of moving from episode to episode.
    No threshold cuts it, while one adversary just above the level with one robot and just below it
    with the other makes a difference of `worst_at` jump (`benchmarks.coverage`).

    Args:
        frontier: A measurement.
        level: Naturalness of `worst_at` and `hull_at`, in [0, 1].

    Raises:
        UserError: A point of the measurement is malformed.
    """
    seeds = [int(seed) for seed in frontier.data["auc_by_seed"]]
    anchor = frontier.data["canonical"]["adversarialness"]
    try:
        by_seed = sound_points_by_seed(measured_points(frontier.points), seeds)
        return {
            "worst_at": Number({str(s): worst_at(p, level, anchor) for s, p in by_seed.items()}),
            "hull_at": Number(
                {str(s): float(hull_at(p, [level], anchor)[0]) for s, p in by_seed.items()}
            ),
            "auc_natural": Number({str(s): auc_natural(p, anchor) for s, p in by_seed.items()}),
            "auc": Number({str(s): area_under_frontier(p, anchor) for s, p in by_seed.items()}),
            "auc_staircase": Number(
                {str(s): area_under_frontier(p, anchor, "staircase") for s, p in by_seed.items()}
            ),
        }
    except ValueError as error:
        raise UserError(f"{frontier.directory}/frontier.json: {error}: measure again") from None


def compare(
    frontiers: Mapping[str, Frontier],
    identities: Mapping[str, Mapping[str, Any]],
    *,
    level: float = HEADLINE_LEVEL,
) -> list[Row]:
    """Rows of a comparison; the first robot is the baseline.

    Args:
        frontiers: Measurements by name.
        identities: What each was measured with: `identity` of its settings.json, by the same names.
        level: Naturalness of `worst_at` and `hull_at`.

    Raises:
        UserError: Two measurements are not of the same measure, or have no seed in common.
    """
    names = list(frontiers)
    baseline = names[0]
    for name in names[1:]:
        check_comparable(
            (baseline, frontiers[baseline], identities[baseline]),
            (name, frontiers[name], identities[name]),
        )
    numbers = {name: numbers_of(frontier, level) for name, frontier in frontiers.items()}
    return [
        Row(
            name,
            frontiers[name],
            numbers[name],
            None if name == baseline else differences(numbers[name], numbers[baseline]),
        )
        for name in names
    ]


def differences(
    mine: Mapping[str, Number], baseline: Mapping[str, Number]
) -> dict[str, PairedDifference]:
    """Each number minus the baseline's, paired by seed."""
    return {
        key: paired_difference(number.by_seed, baseline[key].by_seed)
        for key, number in mine.items()
    }


_Measured = tuple[str, Frontier, Mapping[str, Any]]


def check_comparable(one: _Measured, other: _Measured) -> None:
    """Refuses two measurements that are not of the same measure.

    Raises:
        UserError: Names the first difference: range of y, task, budget, measure, referee, seeds.
    """
    (left, a, mine), (right, b, theirs) = one, other
    both = f"{left} and {right} cannot be compared"
    tasks = [identity.get("task", {}).get("name") for identity in (mine, theirs)]
    if tasks[0] != tasks[1]:
        raise UserError(f"{both}: one was measured in task {tasks[0]}, the other in {tasks[1]}")
    ranges = [list(frontier.data["return_range"]) for frontier in (a, b)]
    if ranges[0] != ranges[1]:
        raise UserError(
            f"{both}: their ranges of adversarialness are {ranges[0]} and {ranges[1]}; measure "
            "both with the same range"
        )
    shared = [{k: v for k, v in identity.items() if k not in _OWN} for identity in (mine, theirs)]
    different = first_difference(*shared)
    if different is not None:
        name, here, there = different
        presets = [frontier.data.get("preset") for frontier in (a, b)]
        said = "" if presets[0] == presets[1] else f" (presets {presets[0]} and {presets[1]})"
        raise UserError(
            f"{both}: {name} is {here} for the one and {there} for the other{said}; measure both "
            "with the same settings"
        )
    lambdas = [identity.get("lambdas") for identity in (mine, theirs)]
    if lambdas[0] != lambdas[1]:
        raise UserError(f"{both}: their λ are {lambdas[0]} and {lambdas[1]}; null is a search")
    if not a.data["auc_by_seed"].keys() & b.data["auc_by_seed"].keys():
        seeds = [sorted(frontier.data["auc_by_seed"], key=int) for frontier in (a, b)]
        raise UserError(
            f"{both}: they share no search seed ({', '.join(seeds[0])} and {', '.join(seeds[1])}); "
            "add seeds with --seeds"
        )


def repeat_spread(number: Number) -> float | None:
    """How far two whole measurements of the same robot may lie apart (95 %), from its own seeds.

    Ours: t · s · √(2/n), the half-width of the interval of a difference between two means of n
    fresh seeds each; None for one seed. A smaller difference between robots says nothing.
    """
    interval = t_interval(list(number.by_seed.values()), bounds=(float("-inf"), float("inf")))
    return None if interval is None else (interval.high - interval.low) / 2**0.5

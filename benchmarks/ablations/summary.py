"""From adversaries and readings to tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from benchmarks.ablations.plan import Variant
from benchmarks.ablations.sizes import JUDGES, Reading, humans_of
from benchmarks.ablations.training import Point
from benchmarks.paired import Row, compared
from rigid.frontier.curve import area_under_frontier, auc_natural
from rigid.frontier.intervals import t_interval
from rigid.frontier.statistics import MAX_FAULTED_SHARE

DEFAULT_NAME = "default"
MEANS = (
    "naturalness", "adversarialness", "converged", "accuracy_canonical", "accuracy_adversary",
)  # fmt: skip
"""Averaged over λ."""
AREAS: dict[str, Callable[[np.ndarray, float], float]] = {
    "auc": area_under_frontier,
    "auc_natural": auc_natural,
}
NUMBERS = (*MEANS, *AREAS)


def variant_rows(
    found: Mapping[str, Sequence[Point]], variants: Sequence[Variant], anchor: float
) -> list[Row]:
    """Every number of every variant, against the default on the same seeds and λ.

    Args:
        found: Adversaries by name of the variant.
        variants: What they are; the default first.
        anchor: Adversarialness of canonical play.
    """
    numbers = {name: numbers_of(points, anchor) for name, points in found.items()}
    default = numbers[DEFAULT_NAME]
    rows = []
    for variant in variants:
        label = {"name": variant.name, "factor": variant.factor}
        for number, mine in numbers[variant.name].items():
            if variant.name == DEFAULT_NAME:
                rows.append(compared(label, number, mine))
            else:
                theirs = default[number]
                row = compared(label, number, mine, reference=DEFAULT_NAME, theirs=theirs)
                rows.append(row)
    return rows


def numbers_of(points: Sequence[Point], anchor: float) -> dict[str, dict[int, float]]:
    """The numbers of one variant, each by seed; a seed without a sound adversary has none.

    Example:
        >>> point = {"seed": 0, "lambda": 1.0, "naturalness": 0.5, "adversarialness": 1.0,
        ...          "converged": True, "accuracy_canonical": 1.0, "accuracy_adversary": 0.5,
        ...          "faults": 0, "episodes": 10}
        >>> found = numbers_of([point], anchor=0.0)
        >>> found["auc"], found["naturalness@1"]
        ({0: 0.75}, {0: 0.5})
    """
    sound = [point for point in points if is_sound(point)]
    seeds = sorted({point["seed"] for point in sound})
    by_seed = {seed: [point for point in sound if point["seed"] == seed] for seed in seeds}
    found: dict[str, dict[int, float]] = {
        name: {seed: _mean(mine, name) for seed, mine in by_seed.items()} for name in MEANS
    }
    for name, area in AREAS.items():
        found[name] = {seed: area(_pairs(mine), anchor) for seed, mine in by_seed.items()}
    for lambda_ in dict.fromkeys(point["lambda"] for point in points):
        for name in MEANS[:2]:
            found[at(name, lambda_)] = {
                point["seed"]: float(point[name]) for point in sound if point["lambda"] == lambda_
            }
    return found


def at(number: str, lambda_: float) -> str:
    """The name of a number at one λ.

    Example:
        >>> at("naturalness", 0.4)
        'naturalness@0.4'
    """
    return f"{number}@{lambda_:g}"


def is_sound(point: Point) -> bool:
    """Whether few enough episodes faulted for an adversary to count."""
    known = point["adversarialness"] is not None
    return bool(known and point["faults"] <= MAX_FAULTED_SHARE * point["episodes"])


def size_rows(readings: Sequence[Reading]) -> list[Row]:
    """Mean reading of each judge, human and size over canonical sets, with t intervals."""
    rows = []
    for judge in JUDGES:
        for human in humans_of(readings):
            mine = [r for r in readings if r["judge"] == judge and r["human"] == human]
            for episodes in sorted({reading["episodes"] for reading in mine}):
                these = [reading for reading in mine if reading["episodes"] == episodes]
                row: Row = {"judge": judge, "human": human, "episodes": episodes}
                for name in ("naturalness", "canonical_passed"):
                    values = [reading[name] for reading in these]
                    ends = t_interval(values)
                    row[name] = sum(values) / len(values)
                    row[f"{name}_low"] = None if ends is None else ends.low
                    row[f"{name}_high"] = None if ends is None else ends.high
                rows.append({**row, "sets": len(these)})
    return rows


def _mean(points: Sequence[Point], name: str) -> float:
    return float(np.mean([float(point[name]) for point in points]))


def _pairs(points: Sequence[Point]) -> np.ndarray:
    pairs = [(point["naturalness"], point["adversarialness"]) for point in points]
    return np.array(pairs, dtype=float)

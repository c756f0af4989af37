"""Tables of the comparison: one row for each way of making robots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean
from typing import Any

from benchmarks.paper.crossplay import own_success, unseen_success
from benchmarks.paper.making import SCRATCH, TWICE
from benchmarks.paper.measuring import THOROUGH, Measuring, body_run
from benchmarks.paper.plan import RECIPES, Plan
from rigid.frontier.methods import compare_methods
from rigid.frontier.result import Frontier
from rigid.report.tables import COLUMNS, Row, method_row, with_ends

Measured = dict[str, dict[int, Frontier]]
"""Frontiers by method and robot seed."""
TITLES = {
    "vanilla": "Vanilla RL", "gleave": "Gleave et al.", "palm": "PALM", "robust-gt": "Robust GT",
    SCRATCH: "Robust GT, from scratch", TWICE: "Robust GT, two rounds",
}  # fmt: skip
PAPER = {
    "vanilla": (0.630, 1.0), "gleave": (0.584, 0.83), "palm": (0.668, 0.95),
    "robust-gt": (0.473, 1.0),
}  # fmt: skip
"""AUC and success that the paper prints (its table in section 5.3)."""

LEVELS = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
"""Naturalness from which on `worst_at` looks, in the table of levels. Ours."""
FLOOR_SHARE = 0.1
"""Mean distance of [0.8, 1] from 1: the weight of sabotage in the line's mean height."""
NATURAL = (0.4, 0.8)
"""Naturalness of the failure cases that the paper shows (section 5.1)."""
FAILURE = 0.8
"""Success below which a human breaks the robot. Ours."""


def measured_recipes(plan: Plan, measuring: Measuring) -> Measured:
    """Every recipe's frontiers that are there, variants last."""
    found: Measured = {}
    for name in (*RECIPES, SCRATCH, TWICE):
        frontiers = {seed: measuring.frontier(name, seed) for seed in plan.robot_seeds}
        present = {seed: run for seed, run in frontiers.items() if run is not None}
        if present:
            found[name] = present
    return found


def measured_thoroughly(plan: Plan, measuring: Measuring) -> Measured:
    """The first robot of each recipe with the paper's own budget, as far as it is there."""
    found = {name: measuring.frontier(f"{name}{THOROUGH}", plan.first) for name in RECIPES}
    return {name: {plan.first: run} for name, run in found.items() if run is not None}


def measured_bodies(plan: Plan, measuring: Measuring) -> Measured:
    """The first vanilla robot with the reference person, then with others."""
    seed = plan.first
    runs = {"reference person": measuring.frontier("vanilla", seed)}
    runs |= {label: measuring.frontier(body_run(label), seed) for label in plan.bodies}
    return {label: {seed: run} for label, run in runs.items() if run is not None}


def method_rows(measured: Measured, crossplay: Sequence[Mapping[str, Any]]) -> list[Row]:
    """`table.csv`: numbers with intervals, and success with the own synthetic human.

    Args:
        measured: Of which the first is the baseline.
        crossplay: From `crossplay.play_all`; robots that are not in it have no success.
    """
    if not measured:
        return []
    return [
        method_row(method, own_success(crossplay, method.name, measured[method.name]))
        for method in compare_methods(measured)
    ]


def difference_rows(measured: Measured) -> list[Row]:
    """`differences.csv`: every number minus the baseline's, with its interval."""
    rows = []
    for method in compare_methods(measured) if measured else []:
        for number, found in (method.against or {}).items():
            rows.append({"method": method.name, "number": number,
                         **with_ends("difference", found)})  # fmt: skip
    return rows


def unseen_rows(measured: Measured, crossplay: Sequence[Mapping[str, Any]]) -> list[Row]:
    """`unseen.csv`: success with the synthetic humans of other robot seeds."""
    return [
        {"method": name, **with_ends("success", unseen_success(crossplay, name))}
        for name in measured
    ]


def level_rows(measured: Measured) -> list[Row]:
    """`levels.csv`: `worst_at` from several naturalness on, and minus the baseline's."""
    rows: list[Row] = []
    for level in LEVELS if measured else ():
        for method in compare_methods(measured, level):
            row: Row = {"naturalness": level, "method": method.name}
            row |= with_ends("worst_at", method.numbers["worst_at"])
            against = None if method.against is None else method.against["worst_at"]
            rows.append(row | with_ends("difference", against))
    return rows


def floor_rows(measured: Measured) -> list[Row]:
    """`floors.csv`: `auc_natural`, and what it would be if no natural human did any harm.

    A human who sabotages now and then, and is canonical else, stands on the straight line between
    the most harmful adversary at naturalness 0 and canonical play: no search that finds sabotage
    can read less than the mean height of that line over [0.8, 1]. Mean over robots and seeds.
    """
    rows: list[Row] = []
    for method in compare_methods(measured) if measured else []:
        floors = [
            FLOOR_SHARE * sabotage + (1 - FLOOR_SHARE) * run.data["canonical"]["adversarialness"]
            for run in measured[method.name].values()
            for sabotage in _most_harmful(run).values()
        ]
        rows.append({
            "method": method.name, "auc_natural": method.numbers["auc_natural"].mean,
            "floor": fmean(floors),
        })  # fmt: skip
    return rows


def _most_harmful(run: Frontier) -> dict[str, float]:
    """The largest adversarialness that each search seed found."""
    found = dict.fromkeys(run.data["auc_by_seed"], 0.0)
    for point in run.points:
        seed = str(point["seed"])
        found[seed] = max(found[seed], point["adversarialness"] or 0.0)
    return found


def natural_failure_rows(measured: Measured) -> list[Row]:
    """`natural.csv`: what was found where the paper reports its failure cases.

    A human counts as a failure when the robot helps it in less than four of five episodes (ours).
    """
    low, high = NATURAL
    rows: list[Row] = []
    for name, robots in measured.items():
        found = [
            (point, seed) for seed, frontier in robots.items() for point in frontier.points
            if low <= point["naturalness"] <= high and point["success"] is not None
        ]  # fmt: skip
        worst, seed = min(found, key=lambda one: one[0]["success"], default=({}, None))
        rows.append({
            "method": name, "humans": len(found),
            "failures": sum(point["success"] < FAILURE for point, _ in found),
            "worst_success": worst.get("success"), "worst_naturalness": worst.get("naturalness"),
            "worst_adversarialness": worst.get("adversarialness"), "robot_seed": seed,
            "point": worst.get("id"),
        })  # fmt: skip
    return rows


def body_rows(measured: Measured) -> list[Row]:
    """`bodies.csv`: the first vanilla robot with other people; canonical play beside it."""
    rows = []
    for method in compare_methods(measured) if measured else []:
        (frontier,) = measured[method.name].values()
        row: Row = {"person": method.name, "success": frontier.data["canonical"]["success"]}
        row["canonical_adversarialness"] = frontier.data["canonical"]["adversarialness"]
        for number, column in COLUMNS.items():
            row |= with_ends(column, method.numbers[number])
        rows.append({**row, "search_seeds": method.seeds})
    return rows

"""What was measured of each robot, and the rows of the tables that say it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from benchmarks.prediction.plan import GROUPS, HumanPlan
from benchmarks.prediction.predictors import PREDICTORS, WITH_INTERVAL, interval_of
from benchmarks.robots import RobotPlan

Target = Literal["adversarialness", "unhelped"]
TARGETS: tuple[Target, ...] = ("adversarialness", "unhelped")
"""Failure with a human: mean adversarialness, and 1 - success."""
PEOPLE = ("all", *GROUPS)
Row = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Subject:
    """One robot with all that was measured of it."""

    plan: RobotPlan
    frontier: Mapping[str, Any]
    """`frontier.json`."""
    numbers: Mapping[str, float]
    """Each predictor."""
    redrawn: Mapping[str, Float[np.ndarray, " R"]]
    """Each predictor, from redrawn search seeds."""
    meetings: Mapping[str, Mapping[str, Any]]
    """What `evaluate` says of it with each unseen human, by the human's name."""

    @property
    def own_success(self) -> float:
        """Success with the human that it was trained for."""
        return float(self.frontier["canonical"]["success"])

    def failure(self, humans: Iterable[HumanPlan], target: Target) -> float:
        """Mean over the humans."""
        return float(np.mean([_failed(self.meetings[human.name], target) for human in humans]))

    def failure_se(self, humans: Sequence[HumanPlan], target: Target) -> float:
        """Standard error of `failure` over episodes, these humans given."""
        span = self.frontier["return_range"][1] - self.frontier["return_range"][0]
        squares = [_square_error(self.meetings[human.name], target, span) for human in humans]
        return float(np.sqrt(sum(squares)) / len(squares))


def _failed(meeting: Mapping[str, Any], target: Target) -> float:
    if target == "adversarialness":
        return float(meeting["adversarialness"])
    return 1.0 - float(meeting["success"])


def _square_error(meeting: Mapping[str, Any], target: Target, span: float) -> float:
    """Squared standard error; of adversarialness an upper bound, since clipping only narrows."""
    sound = meeting["episodes"] - meeting["faults"]
    if target == "adversarialness":
        return float((meeting["return_std"] / span) ** 2 / sound)
    return float(meeting["success"] * (1 - meeting["success"]) / sound)


def among(people: str, humans: Sequence[HumanPlan]) -> list[HumanPlan]:
    """The humans of one group, or all."""
    return [human for human in humans if people in ("all", human.group)]


def table_rows(subjects: Sequence[Subject], humans: Sequence[HumanPlan]) -> list[Row]:
    """One row for each robot: how it was made, its numbers, its failures."""
    return [_table_row(subject, humans) for subject in subjects]


def _table_row(subject: Subject, humans: Sequence[HumanPlan]) -> Row:
    row: Row = {
        "robot": subject.plan.name,
        "iterations": subject.plan.iterations,
        "seed": subject.plan.seed,
        "noise_start": subject.plan.std[0],
        "noise_end": subject.plan.std[1],
        "success": subject.own_success,
    }
    for name in PREDICTORS:
        row[name] = _known(subject.numbers[name])
        if name in WITH_INTERVAL:
            low, high = interval_of(subject.frontier, name) or (None, None)
            row |= {f"{name}_low": low, f"{name}_high": high}
    for people, target in product(PEOPLE, TARGETS):
        chosen = among(people, humans)
        row[f"{target}_{people}"] = subject.failure(chosen, target)
        row[f"{target}_{people}_se"] = subject.failure_se(chosen, target)
    return row


def human_rows(subjects: Sequence[Subject], humans: Sequence[HumanPlan]) -> list[Row]:
    """One row for each robot and human."""
    return [
        {
            "robot": subject.plan.name, "human": human.name, "group": human.group,
            "seed": human.seed,
            **{key: subject.meetings[human.name][key] for key in _MEASURED},
        }
        for subject in subjects for human in humans
    ]  # fmt: skip


_MEASURED = ("episodes", "faults", "success", "adversarialness", "return", "return_std")


def _known(value: float) -> float | None:
    return None if np.isnan(value) else float(value)

"""Which number said before how a robot would do: correlations, and differences between them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Float

from benchmarks.prediction.assembling import PEOPLE, TARGETS, Row, Subject, Target, among
from benchmarks.prediction.correlation import (
    MIN_ROBOTS,
    Resamples,
    kendall,
    partial_kendall,
    percentile_interval,
    permutation_p,
    resample,
    spearman,
)
from benchmarks.prediction.plan import HumanPlan
from benchmarks.prediction.predictors import BASELINE, PREDICTORS

COMPETENT = 0.95
"""Least success with its own human of a robot that anybody would think of deploying. Ours."""
SETS = ("all", "competent")
CONTRASTS = (
    ("worst_at_0.9", "auc"),
    ("auc_natural", "auc"),
    ("worst_at_0.9", BASELINE),
    ("auc_natural", BASELINE),
    ("auc", BASELINE),
)
"""Pairs of numbers of which the study asks which one predicts better."""


@dataclass(frozen=True)
class _Question:
    """Some robots and how often they failed with some people."""

    robots: str
    people: str
    target: Target
    subjects: Sequence[Subject]
    failure: Float[np.ndarray, " n"]
    resamples: Resamples

    @property
    def label(self) -> Row:
        return {
            "robots": self.robots, "n": len(self.subjects),
            "humans": self.people, "target": self.target,
        }  # fmt: skip

    def measured(self, name: str) -> Float[np.ndarray, " n"]:
        """A predictor of each robot."""
        return np.array([subject.numbers[name] for subject in self.subjects])

    def redrawn(self, name: str) -> Float[np.ndarray, "n R"]:
        """A predictor of each robot from redrawn search seeds."""
        return np.stack([subject.redrawn[name] for subject in self.subjects])


def correlation_rows(
    subjects: Sequence[Subject], humans: Sequence[HumanPlan], *, resamples: int
) -> list[Row]:
    """One row for each set of robots, group of people, target and predictor.

    `tau_low` and `tau_high` are over robots and search seeds together; `tau_robots_*` takes the
    headline as it was measured, `tau_seeds_*` the robots as they are. `tau_partial` is what the
    number says beyond the baseline. Unknown values are None: fewer than four robots, or no two
    that differ.
    """
    return [
        {**question.label, "predictor": name, **_association(question, name)}
        for question in _questions(subjects, humans, resamples)
        for name in PREDICTORS
    ]


def difference_rows(
    subjects: Sequence[Subject], humans: Sequence[HumanPlan], *, resamples: int
) -> list[Row]:
    """One row for each contrast: how much better the first number predicts than the second.

    Both numbers are resampled together, so the interval is that of a paired difference.
    """
    return [
        {**question.label, "first": first, "second": second, **_difference(question, first, second)}
        for question in _questions(subjects, humans, resamples)
        for first, second in CONTRASTS
    ]


def _questions(
    subjects: Sequence[Subject], humans: Sequence[HumanPlan], resamples: int
) -> Iterator[_Question]:
    for robots in SETS:
        chosen = [s for s in subjects if robots == "all" or s.own_success >= COMPETENT]
        redraws = len(subjects[0].redrawn[BASELINE])
        # The same resamples for every question about these robots, so that answers compare.
        drawn = resample(max(len(chosen), 1), redraws, resamples, np.random.default_rng(0))
        for people, target in product(PEOPLE, TARGETS):
            met = among(people, humans)
            failure = np.array([subject.failure(met, target) for subject in chosen])
            yield _Question(robots, people, target, chosen, failure, drawn)


def _association(question: _Question, name: str) -> Row:
    if len(question.subjects) < MIN_ROBOTS:
        return dict.fromkeys(_COLUMNS)
    x, y, baseline = question.measured(name), question.failure, question.measured(BASELINE)
    drawn, redrawn = question.resamples, question.redrawn(name)
    alone = drawn.same_robots()
    both_x, both_y = drawn.of_redrawn(redrawn), drawn.of(y)
    rng = np.random.default_rng(0)
    partial = name != BASELINE  # Nothing adds to itself.
    return {
        "tau": _known(kendall(x, y)),
        **_ends("tau", kendall(both_x, both_y)),
        **_ends("tau_robots", kendall(drawn.of(x), both_y)),
        **_ends("tau_seeds", kendall(alone.of_redrawn(redrawn), alone.of(y))),
        "tau_p": permutation_p(x, y, kendall, rng),
        "rho": _known(spearman(x, y)),
        **_ends("rho", spearman(both_x, both_y)),
        "rho_p": permutation_p(x, y, spearman, rng),
        "tau_partial": _known(partial_kendall(x, y, baseline)) if partial else None,
        **_ends(
            "tau_partial",
            partial_kendall(both_x, both_y, drawn.of(baseline)) if partial else np.array([np.nan]),
        ),
    }


_COLUMNS = (
    "tau", "tau_low", "tau_high", "tau_robots_low", "tau_robots_high", "tau_seeds_low",
    "tau_seeds_high", "tau_p", "rho", "rho_low", "rho_high", "rho_p", "tau_partial",
    "tau_partial_low", "tau_partial_high",
)  # fmt: skip


def _difference(question: _Question, first: str, second: str) -> Row:
    if len(question.subjects) < MIN_ROBOTS:
        return dict.fromkeys(("tau_difference", "tau_difference_low", "tau_difference_high"))
    y, drawn = question.failure, question.resamples
    measured = [kendall(question.measured(name), y) for name in (first, second)]
    resampled = [
        kendall(drawn.of_redrawn(question.redrawn(name)), drawn.of(y)) for name in (first, second)
    ]
    return {
        "tau_difference": _known(measured[0] - measured[1]),
        **_ends("tau_difference", resampled[0] - resampled[1]),
    }


def _ends(name: str, resampled: Float[np.ndarray, " B"]) -> Row:
    low, high = percentile_interval(resampled) or (None, None)
    return {f"{name}_low": low, f"{name}_high": high}


def _known(value: Float[np.ndarray, ""]) -> float | None:
    return None if np.isnan(value) else float(value)


def find(rows: Sequence[Row], **wanted: str) -> Row:
    """The one row with these labels."""
    (found,) = [row for row in rows if all(row[key] == value for key, value in wanted.items())]
    return found

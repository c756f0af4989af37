"""Is the order of the robots' headline numbers the order of their failures with people?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from jaxtyping import Float

from rigid.errors import UserError
from rigid.frontier.comparison import check_comparable, numbers_of
from rigid.frontier.intervals import Interval, paired_difference
from rigid.study.analysis.order import (
    PeopleDifference,
    Verdict,
    order_test,
    people_difference,
    verdict,
)
from rigid.study.analysis.placing import Placed
from rigid.study.analysis.reading import MeasuredRobot
from rigid.study.analysis.settings import AnalysisSettings

HEADLINES = ("worst_at", "hull_at", "auc_natural", "auc")
"""Numbers whose order is held against people, in the order of the report; the first is the one that
the paper's claim is tested with, the others stand beside it."""


@dataclass(frozen=True, kw_only=True)
class Headline:
    """The difference of one headline number of two robots, and what people say to it."""

    name: str
    mean: float
    """Second minus first."""
    interval: Interval | None
    """Over search seeds."""
    verdict: Verdict


@dataclass(frozen=True, kw_only=True)
class RobotPair:
    """Two robots."""

    first: str
    second: str
    people: PeopleDifference
    """Share of failed episodes, second minus first."""
    harm: PeopleDifference
    """Adversarialness, second minus first."""
    headlines: tuple[Headline, ...]
    """Empty where the runs cannot be compared."""
    why: str | None
    """Why they cannot."""


@dataclass(frozen=True, kw_only=True)
class RobotOrder:
    """All robots together."""

    pairs: tuple[RobotPair, ...]
    p: float | None
    """Of `order_test` over all robots by `worst_at`; None below three robots or without people who
    met them all."""
    people: int
    """Who met all of them."""


def robot_order(
    robots: Mapping[str, MeasuredRobot], placed: Sequence[Placed], settings: AnalysisSettings
) -> RobotOrder | None:
    """Compares every two robots; None below two, or where nobody played. People alone.

    A person meets every robot with the same device, so that devices cancel.
    """
    if len(robots) < 2 or not placed:
        return None
    failures = _by_person(placed, failed=True)
    harm = _by_person(placed, failed=False)
    rng = np.random.default_rng(settings.seed)
    pairs = tuple(
        _pair(robots[a], robots[b], failures, harm, settings, rng)
        for a, b in combinations(robots, 2)
    )
    table = _met(failures, list(robots))
    p = None
    if len(robots) > 2 and len(table):
        worst = [numbers_of(robot.frontiers[0])[HEADLINES[0]].mean for robot in robots.values()]
        p = order_test(table, np.array(worst), permutations=settings.permutations, rng=rng)
    return RobotOrder(pairs=pairs, p=p, people=len(table))


_Values = Mapping[str, Mapping[str, Mapping[str, float]]]
"""By person, kind of device and robot."""


def _by_person(placed: Sequence[Placed], *, failed: bool) -> _Values:
    """Share of failures, or mean adversarialness."""
    found: dict[str, dict[str, dict[str, float]]] = {}
    for one in placed:
        value = one.adversarialness
        if failed:
            value = None if one.success is None else 1.0 - one.success
        if one.player.scripted or value is None:
            continue
        mine = found.setdefault(one.player.code, {}).setdefault(one.player.device, {})
        mine[one.player.robot] = value
    return found


def _met(values: _Values, robots: Sequence[str]) -> Float[np.ndarray, "n r"]:
    """A row for each person who met all of `robots` with one kind of device; mean of several."""
    rows = []
    for devices in values.values():
        whole = [[mine[r] for r in robots] for mine in devices.values() if {*robots} <= mine.keys()]
        if whole:
            rows.append(np.mean(whole, axis=0))
    return np.array(rows, dtype=float).reshape(-1, len(robots))


def _pair(
    a: MeasuredRobot,
    b: MeasuredRobot,
    failures: _Values,
    harm: _Values,
    settings: AnalysisSettings,
    rng: np.random.Generator,
) -> RobotPair:
    def apart(values: _Values) -> PeopleDifference:
        table = _met(values, [a.key, b.key])
        return people_difference(
            table[:, 0], table[:, 1], permutations=settings.permutations, rng=rng,
            confidence=settings.confidence,
        )  # fmt: skip

    people = apart(failures)
    why, headlines = _headlines(a, b, people, settings)
    return RobotPair(
        first=a.key, second=b.key, people=people, harm=apart(harm), headlines=headlines, why=why
    )


def _headlines(
    a: MeasuredRobot, b: MeasuredRobot, people: PeopleDifference, settings: AnalysisSettings
) -> tuple[str | None, tuple[Headline, ...]]:
    """The differences of the headline numbers; of several runs of a robot the first counts."""
    one, other = a.runs[0], b.runs[0]
    try:
        check_comparable(
            (a.key, one.frontier, one.identity), (b.key, other.frontier, other.identity)
        )
    except UserError as error:
        return str(error), ()
    mine, theirs = numbers_of(one.frontier), numbers_of(other.frontier)
    found = []
    for name in HEADLINES:
        apart = paired_difference(theirs[name].by_seed, mine[name].by_seed, settings.confidence)
        found.append(Headline(
            name=name, mean=apart.mean, interval=apart.interval,
            verdict=verdict(apart.interval, people, alpha=1 - settings.confidence),
        ))  # fmt: skip
    return None, tuple(found)

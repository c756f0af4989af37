"""How methods stand beside each other: numbers, differences, and success with two kinds of humans.

A method is one robot, or several that were made alike for different synthetic humans.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isclose
from typing import Any, Final

from rigid.frontier.comparison import (
    HEADLINE_LEVEL,
    check_comparable,
    numbers_of,
    repeat_spread,
)
from rigid.frontier.methods import Method, compare_methods
from rigid.frontier.result import Frontier, lacking
from rigid.frontier.successes import Played, Success, success_of

TITLES: Final[Mapping[str, str]] = {
    "worst_at": f"worst at ≥ {HEADLINE_LEVEL}",
    "hull_at": f"hull at {HEADLINE_LEVEL}",
    "auc_natural": "mean over [0.8, 1]",
    "auc": "AUC",
}
"""The numbers of a comparison, as people read them; in the order of `NUMBERS`."""

Measured = tuple[Frontier, Mapping[str, Any]]
"""A measurement and what it was made with: `identity` of its settings.json."""


@dataclass(frozen=True)
class Standing:
    """One method of a comparison; the first is the baseline."""

    method: Method
    robots: Sequence[Frontier]
    success: Success | None
    """With each robot's own synthetic human, as its measurement found; None where the task defines
    no success."""
    unseen: Success | None
    """With humans that the robots were not made for; None where nobody was asked."""


def standings_of(
    methods: Mapping[str, Sequence[Measured]], unseen: Sequence[Played] = ()
) -> list[Standing]:
    """Compares methods: robot i of one pairs with robot i of the others, and seeds pair as well.

    Args:
        methods: Measurements of each method's robots; the first method is the baseline.
        unseen: What robots achieved with other humans; `robot` counts through all robots of all
            methods.

    Raises:
        UserError: Two measurements are not of the same measure, or share no search seed.
    """
    _check_all(methods)
    robots = {name: [frontier for frontier, _ in measured] for name, measured in methods.items()}
    found = compare_methods({name: dict(enumerate(mine)) for name, mine in robots.items()})
    standings, begun = [], 0
    for method in found:
        mine = robots[method.name]
        met = [one for one in unseen if begun <= one.robot < begun + len(mine)]
        begun += len(mine)
        standings.append(Standing(method, mine, success_of(_canonical(mine)), success_of(met)))
    return standings


def notes_of(standings: Sequence[Standing]) -> list[str]:
    """What a reader of the comparison has to know, a sentence each."""
    baseline = standings[0]
    notes = [said for standing in standings if (said := _lacking(standing)) is not None]
    if len(baseline.robots) == 1:
        numbers = numbers_of(baseline.robots[0])
        spreads = {key: repeat_spread(numbers[key]) for key in TITLES}
        known = [f"{spread:.3f} for {TITLES[key]}" for key, spread in spreads.items() if spread]
        if known:
            name = baseline.method.name
            notes.append(
                f"to judge by its seeds alone, a repeat of {name} should lie within "
                f"{', '.join(known)} of it; in repeats of an itch-scratching robot with all drawn "
                "anew 40 to 83 % did (results/reliability)"
            )
    if any(len(standing.robots) > 1 for standing in standings):
        notes.append(
            "95 % intervals over robots and search seeds, which speak of a method and not of these "
            "robots; over seeds alone where a method has one robot"
        )
    if any(standing.unseen is not None for standing in standings):
        notes.append(
            "success with unseen humans is the mean over those that were named; others may be "
            "harder to help"
        )
    steadier = (
        f"{TITLES['hull_at']} tells robots apart more steadily: 95 % intervals of its differences "
        f"covered 94 to 96 %, those of {TITLES['worst_at']} 76 to 87 % (results/coverage)"
    )
    straight = [standing.method.name for standing in standings if _is_straight(standing)]
    if straight:
        notes.append(
            f"{TITLES['hull_at']} equals {TITLES['auc_natural']} of {', '.join(straight)}, whose "
            "hulls are straight lines over [0.8, 1], of which 0.9 is the middle: no human that was "
            "found in between rises above them"
        )
    return [*notes, steadier, "lower is more robust; estimates at this search power, not bounds"]


def _lacking(standing: Standing) -> str | None:
    """Says of a method that canonical play stands for some of its worst humans."""
    counts = [robot.seeds_at(HEADLINE_LEVEL) for robot in standing.robots]
    found, searches = (sum(each) for each in zip(*counts, strict=True))
    called = "seeds" if len(counts) == 1 else "searches"
    said = lacking(found, searches, HEADLINE_LEVEL, called=called)
    return None if said is None else f"{standing.method.name}: {said}"


def _is_straight(standing: Standing) -> bool:
    """Whether every hull is a line over [0.8, 1]: a concave one's mean is its middle only then."""
    numbers = standing.method.numbers
    return isclose(numbers["hull_at"].mean, numbers["auc_natural"].mean, abs_tol=1e-9)


def unlike_pairs(methods: Mapping[str, Sequence[Measured]]) -> list[str]:
    """Sentences on paired robots that were measured with different synthetic humans.

    Where a method has several robots, their order says which of them belong together.
    """
    several = max(map(len, methods.values())) > 1
    (baseline, first), *others = methods.items()

    def said(name: str, number: int) -> str:
        if several:
            return (
                f"robot {number} of {name} was measured with another synthetic human than robot "
                f"{number} of {baseline}: the two pair by their order alone"
            )
        return (
            f"{name} was measured with another synthetic human than {baseline}: what is natural "
            "is not the same for both"
        )

    return [
        said(name, number)
        for name, robots in others
        for number, ((_, mine), (_, theirs)) in enumerate(zip(robots, first, strict=False), 1)
        if mine.get("human") != theirs.get("human")
    ]


def _check_all(methods: Mapping[str, Sequence[Measured]]) -> None:
    everyone = [
        (name if len(measured) == 1 else f"{name} ({frontier.directory})", frontier, identity)
        for name, measured in methods.items()
        for frontier, identity in measured
    ]
    for other in everyone[1:]:
        check_comparable(everyone[0], other)


def _canonical(robots: Sequence[Frontier]) -> Iterator[Played]:
    """Each robot's canonical play, where its success is known."""
    for number, frontier in enumerate(robots):
        played = frontier.data["canonical"]
        if played["success"] is not None:
            yield Played(number, float(played["success"]), int(played["episodes"]))

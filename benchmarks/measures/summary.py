"""From points to tables: headline numbers, what each measure finds alone, and unions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.measures.plan import ENSEMBLE, MEMBERS, REFERENCE, again_name
from benchmarks.measures.searching import Searched, joined
from benchmarks.measures.shares import Found, alone, exclusive_area
from benchmarks.paired import Row, compared, plain
from rigid.frontier.comparison import HEADLINE_LEVEL
from rigid.frontier.curve import area_under_frontier, auc_natural, non_dominated, worst_at
from rigid.frontier.result import measured_points

MARGIN = 0.05
"""Within which two points are alike: a twentieth of each axis. Ours."""
NUMBERS: dict[str, Callable[[Found, float], float]] = {
    f"worst_at_{HEADLINE_LEVEL:g}": lambda points, anchor: worst_at(points, HEADLINE_LEVEL, anchor),
    "auc_natural": auc_natural,
    "auc": area_under_frontier,
}
"""Headline numbers, in the order of `frontier.json`."""
TWICE = "twice"


def headline_rows(searched: Mapping[str, Searched]) -> list[Row]:
    """Headline numbers of each search against the reference, the ensemble's against its members."""
    rows = []
    for name, mine in searched.items():
        against = [] if name == REFERENCE else [REFERENCE]
        if name == ENSEMBLE:
            against = [member for member in MEMBERS if member in searched]
        for reference in against or [""]:
            theirs = searched[reference].by_seed() if reference else None
            rows += _numbers(name, 1, mine.by_seed(), mine.anchor, reference, theirs)
    return rows


def union_rows(searched: Mapping[str, Searched]) -> list[Row]:
    """Two searches of different measures against two of one: equal budgets.

    The ensemble twice against its members together, and these against the reference twice.
    """
    found = {name: one.by_seed() for name, one in searched.items()}
    anchor = searched[REFERENCE].anchor
    first, second = MEMBERS
    together = joined(found[first], found[second])
    twice = {name: joined(found[name], found[again_name(name)]) for name in (REFERENCE, ENSEMBLE)}
    return [
        *_numbers(twice_name(ENSEMBLE), 2, twice[ENSEMBLE], anchor, together_name(), together),
        *_numbers(
            together_name(), 2, together, anchor, twice_name(REFERENCE), twice[REFERENCE]
        ),
        *_numbers(twice_name(REFERENCE), 2, twice[REFERENCE], anchor, "", None),
    ]  # fmt: skip


def twice_name(name: str) -> str:
    """Two searches of one measure."""
    return f"{name}, {TWICE}"


def together_name() -> str:
    """One search of each member."""
    return " + ".join(MEMBERS)


def share_rows(searched: Mapping[str, Searched], measures: Sequence[str]) -> list[Row]:
    """What each measure finds alone, and what a second search of the reference adds to them all.

    `exclusive_area` is by seed; `points`, `alone` and `clearly_alone` count over all seeds.
    """
    first = {name: searched[name] for name in measures}
    again = again_name(REFERENCE)
    rows = []
    for name in (*measures, again):
        everybody = first if name in first else {**first, again: searched[again]}
        rows += _shares_of(name, everybody)
    return rows


def cost_rows(searched: Mapping[str, Searched]) -> list[Row]:
    """Processor time of every search, all its seeds, scoring included [s]."""
    return [
        plain({"name": name, "searches": 1}, "core_seconds", one.frontier.data["core_seconds"])
        for name, one in searched.items()
    ]


def point_rows(searched: Mapping[str, Searched], measures: Sequence[str]) -> list[Row]:
    """Every adversary of every search, and whether its measure alone found it."""
    first = {name: searched[name] for name in measures}
    rows = []
    for name, one in searched.items():
        marks = _marks(name, {**first, name: one})
        rows += [
            {
                "name": name, "measure": one.search.measure, "seed": point["seed"],
                "id": point["id"], "round": point["round"], "lambda": point["lambda"],
                "naturalness": point["naturalness"], "naturalness_se": point["naturalness_se"],
                "adversarialness": point["adversarialness"], "success": point["success"],
                "faults": point["faults"], "converged": int(point["converged"]),
                **{key: int(mark) for key, mark in marked.items()},
            }
            for point, marked in zip(one.points, marks, strict=True)
        ]  # fmt: skip
    return rows


def _numbers(
    name: str,
    searches: int,
    mine: Mapping[int, Found],
    anchor: float,
    reference: str,
    theirs: Mapping[int, Found] | None,
) -> list[Row]:
    def of(found: Mapping[int, Found], number: Callable[[Found, float], float]) -> dict[int, float]:
        return {seed: number(points, anchor) for seed, points in found.items()}

    return [
        compared(
            {"name": name, "searches": searches}, key, of(mine, number), reference=reference,
            theirs=None if theirs is None else of(theirs, number),
        )
        for key, number in NUMBERS.items()
    ]  # fmt: skip


def _shares_of(name: str, everybody: Mapping[str, Searched]) -> list[Row]:
    label = {"name": name, "searches": 1}
    by_seed = {other: one.by_seed() for other, one in everybody.items()}
    common = set.intersection(*(set(found) for found in by_seed.values()))
    anchor = everybody[name].anchor
    areas = {
        seed: exclusive_area({other: found[seed] for other, found in by_seed.items()}, name, anchor)
        for seed in sorted(common)
    }
    marks = _marks(name, everybody)
    counts = {key: sum(mark[key] for mark in marks) for key in ("alone", "clearly_alone")}
    return [
        compared(label, "exclusive_area", areas),
        plain(label, "points", len(marks)),
        *(plain(label, key, count) for key, count in counts.items()),
    ]


def _marks(name: str, everybody: Mapping[str, Searched]) -> list[dict[str, bool]]:
    """For each point of one search, as in `points`: False for those that do not count."""
    others = [one for other, one in everybody.items() if other != name]
    canonical = np.array([[1.0, everybody[name].anchor]])  # Whom canonical play beats is no find.
    rest = np.concatenate([canonical, *(_pairs(one.points)[1] for one in others)])
    sound, mine = _pairs(everybody[name].points)
    every = np.concatenate([rest, mine])
    found = {
        "alone": alone(mine, rest),
        "clearly_alone": alone(mine, rest, MARGIN),
        "on_union_frontier": non_dominated(every)[len(rest) :],
    }
    columns = {key: iter(mask.tolist()) for key, mask in found.items()}
    return [
        {key: bool(counts and next(column)) for key, column in columns.items()} for counts in sound
    ]


def _pairs(points: Sequence[Mapping[str, Any]]) -> tuple[list[bool], Found]:
    """Which points count, and those that do."""
    sound = [is_sound(point) for point in points]
    pairs = [
        (point["naturalness"], point["adversarialness"])
        for point, counts in zip(points, sound, strict=True)
        if counts
    ]
    return sound, np.array(pairs, dtype=float).reshape(-1, 2)


def is_sound(point: Mapping[str, Any]) -> bool:
    """Whether few enough episodes of an entry of `frontier.json` faulted for it to count."""
    (measured,) = measured_points([point])
    return measured.is_sound

"""The comparison of robots or methods as text, for a terminal of 100 columns."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rigid.frontier.intervals import Interval
    from rigid.frontier.methods import Estimate
    from rigid.frontier.standings import Standing
    from rigid.frontier.successes import Success

_WIDTH = 100
_NAME, _NUMBER, _DIFFERENCE, _SUCCESS = 11, 20, 22, 24
"""Of columns: a name with four numbers or four differences just fits."""


def table(standings: Sequence[Standing], notes: Sequence[str] = ()) -> str:
    """The comparison as text: numbers with intervals, differences to the first, successes.

    Args:
        standings: The first is the baseline.
        notes: Sentences below.
    """
    from rigid.frontier.standings import TITLES

    singles = all(len(standing.robots) == 1 for standing in standings)
    asked = any(standing.unseen is not None for standing in standings)
    width = min(max(len(standing.method.name) for standing in standings), _NAME)
    titles = "".join(f"{title:>{_NUMBER}}" for title in TITLES.values())
    lines = [f"{'robot' if singles else 'method':{width}}  {'success':>7}{titles}"]
    for standing in standings:
        cells = [f"{_share(standing.success):>9}"]
        cells += [f"{_number(standing.method.numbers[key]):>{_NUMBER}}" for key in TITLES]
        lines += _row(standing, width, cells)
    if len(standings) > 1:
        lines += ["", *_differences(standings, width, singles=singles)]
    if asked or not singles:
        lines += ["", *_successes(standings, width, asked=asked)]
    wrapped = (textwrap.fill(note, _WIDTH, subsequent_indent="  ") for note in notes)
    return "\n".join([*lines, "", *wrapped])


def _differences(standings: Sequence[Standing], width: int, *, singles: bool) -> Iterator[str]:
    from rigid.frontier.standings import TITLES

    paired = "search seeds" if singles else "robots and search seeds"
    yield f"minus {standings[0].method.name}, on the {paired} that both have"
    for standing in standings[1:]:
        assert standing.method.against is not None  # Every method has a robot.
        found = (standing.method.against[key] for key in TITLES)
        yield from _row(standing, width, [f"{_difference(one):>{_DIFFERENCE}}" for one in found])


def _successes(standings: Sequence[Standing], width: int, *, asked: bool) -> Iterator[str]:
    titles = ("own human", "unseen humans") if asked else ("own human",)
    heads = "".join(f"{title:>{_SUCCESS}}" for title in titles)
    yield f"{'success':{width}}{heads}    robots  search seeds"
    for standing in standings:
        shown = (standing.success, standing.unseen) if asked else (standing.success,)
        cells = [f"{_share(one)}{'' if one is None else _ends(one.interval)}" for one in shown]
        counts = f"{standing.method.robots:10}{standing.method.seeds:14}"
        yield from _row(standing, width, [*(f"{cell:>{_SUCCESS}}" for cell in cells), counts])


def _row(standing: Standing, width: int, cells: Sequence[str]) -> list[str]:
    """One line, or two where the name is longer than its column."""
    name = standing.method.name
    return [f"{name:{width}}{''.join(cells)}"] if len(name) <= width else [
        name, f"{'':{width}}{''.join(cells)}"
    ]  # fmt: skip


def _number(found: Estimate) -> str:
    return f"{found.mean:.3f}{_ends(found.interval)}"


def _difference(found: Estimate) -> str:
    return f"{found.mean:+.3f}{_ends(found.interval, '+.2f')}"


def _share(found: Success | None) -> str:
    return "–" if found is None else f"{found.mean:.2f}"


def _ends(interval: Interval | None, form: str = ".2f") -> str:
    return "" if interval is None else f" [{interval.low:{form}}, {interval.high:{form}}]"

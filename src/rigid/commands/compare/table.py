"""The comparison of robots or methods as text that fits into a terminal."""

from __future__ import annotations

import io
import re
import textwrap
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from rigid.commands.terminal.wrapping import wrapped

if TYPE_CHECKING:
    from rigid.frontier.intervals import Interval
    from rigid.frontier.methods import Estimate
    from rigid.frontier.standings import Standing
    from rigid.frontier.successes import Success

_GAP, _LEAST_GAP = 2, 1
"""Columns between two cells, and where there is no room for that."""
_NAME = 11
"""Columns that a longer name has at least, before the table becomes narrower or parts."""


class _Column(NamedTuple):
    title: str
    cells: Sequence[str]

    @property
    def width(self) -> int:
        return max(len(line) for text in (self.title, *self.cells) for line in text.split("\n"))

    @property
    def narrow(self) -> _Column:
        """The same with intervals below their numbers, and titles in two lines."""
        title = re.sub(r" (?=[≥\[\d]|seeds|humans?)", "\n", self.title, count=1)
        return _Column(title, [cell.replace(" [", "\n[") for cell in self.cells])


class _Folder(textwrap.TextWrapper):
    """Breaks a name behind a sign that parts it, where there is one."""

    wordsep_re = re.compile(r"(?<=[-/_.=])")


def table(standings: Sequence[Standing], notes: Sequence[str] = (), *, width: int = 80) -> str:
    """The comparison as text: numbers with intervals, differences to the first, successes.

    Names fold, numbers never: in a narrow terminal intervals stand below their numbers, and in a
    very narrow one a table comes in parts.

    Args:
        standings: The first is the baseline.
        notes: Sentences below.
        width: Of the terminal, in columns.
    """
    from rigid.frontier.standings import TITLES

    singles = all(len(standing.robots) == 1 for standing in standings)
    asked = any(standing.unseen is not None for standing in standings)
    success = _Column("success", [_share(standing.success) for standing in standings])
    numbers = (
        _Column(title, [_number(standing.method.numbers[key]) for standing in standings])
        for key, title in TITLES.items()
    )
    head, names = "robot" if singles else "method", [one.method.name for one in standings]
    lines = [*_block(head, names, [success, *numbers], width)]
    if len(standings) > 1:
        paired = "search seeds" if singles else "robots and search seeds"
        title = f"minus {names[0]}, on the {paired} that both have"
        lines += [
            "",
            wrapped(title, width),
            *_block(head, names[1:], _differences(standings), width),
        ]
    if asked or not singles:
        lines += ["", *_block("success", names, _successes(standings, asked=asked), width)]
    return "\n".join([*lines, "", *(wrapped(note, width) for note in notes)])


def _differences(standings: Sequence[Standing]) -> list[_Column]:
    from rigid.frontier.standings import TITLES

    against = [one.method.against for one in standings if one.method.against is not None]
    return [
        _Column(title, [_difference(one[key]) for one in against]) for key, title in TITLES.items()
    ]


def _successes(standings: Sequence[Standing], *, asked: bool) -> list[_Column]:
    def column(title: str, of: Callable[[Standing], Success | None]) -> _Column:
        found = [of(standing) for standing in standings]
        ends = [None if one is None else one.interval for one in found]
        shown = [f"{_share(one)}{_ends(e, '.2f')}" for one, e in zip(found, ends, strict=True)]
        return _Column(title, shown)

    return [
        column("own human", lambda standing: standing.success),
        *([column("unseen humans", lambda standing: standing.unseen)] if asked else []),
        _Column("robots", [str(standing.method.robots) for standing in standings]),
        _Column("search seeds", [str(standing.method.seeds) for standing in standings]),
    ]


def _block(
    head: str, names: Sequence[str], columns: Sequence[_Column], width: int
) -> Iterator[str]:
    """A table, or several below each other that have the same rows, of at most `width` columns."""
    longest = max(map(len, (head, *names)))
    room, gap = width - min(longest, _NAME), _GAP
    if _taken(columns, gap) > room:
        columns = [column.narrow for column in columns]
    if _taken(columns, gap) > room:
        gap = _LEAST_GAP
    for number, part in enumerate(_parts(columns, room, gap)):
        if number > 0:
            yield ""
        name_width = min(longest, max(width - _taken(part, gap), _NAME))
        yield from _drawn(head, names, part, name_width, gap)


def _parts(columns: Sequence[_Column], room: int, gap: int) -> list[Sequence[_Column]]:
    """As few parts as have room, of about equally many columns."""
    for count in range(1, len(columns)):
        size = -(-len(columns) // count)
        parts = [columns[first : first + size] for first in range(0, len(columns), size)]
        if all(_taken(part, gap) <= room for part in parts):
            return parts
    return [[column] for column in columns]


def _taken(columns: Sequence[_Column], gap: int) -> int:
    return sum(gap + column.width for column in columns)


def _drawn(
    head: str, names: Sequence[str], columns: Sequence[_Column], name_width: int, gap: int
) -> Iterator[str]:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    height = max(column.title.count("\n") for column in columns)
    drawn = Table(box=None, padding=(0, 0, 0, gap), pad_edge=False)
    drawn.add_column(Text("\n" * height + head), width=name_width, overflow="fold")
    for column in columns:
        title = "\n" * (height - column.title.count("\n")) + column.title
        drawn.add_column(Text(title), justify="right", min_width=column.width, no_wrap=True)
    folder = _Folder(name_width)
    for name, *cells in zip(names, *(column.cells for column in columns), strict=True):
        drawn.add_row(Text("\n".join(folder.wrap(name))), *map(Text, cells))
    width = name_width + _taken(columns, gap)
    console = Console(file=io.StringIO(), width=width, color_system=None)
    with console.capture() as captured:
        console.print(drawn)
    return (line.rstrip() for line in captured.get().splitlines())


def _number(found: Estimate) -> str:
    return f"{found.mean:.3f}{_ends(found.interval)}"


def _difference(found: Estimate) -> str:
    return f"{found.mean:+.3f}{_ends(found.interval, '+.3f')}"


def _share(found: Success | None) -> str:
    return "–" if found is None else f"{found.mean:.2f}"


def _ends(interval: Interval | None, form: str = ".3f") -> str:
    return "" if interval is None else f" [{interval.low:{form}}, {interval.high:{form}}]"

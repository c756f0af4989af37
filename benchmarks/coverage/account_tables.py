"""The tables of the account, in Markdown: a line for each quantity."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.coverage.ends import INTERVALS
from benchmarks.coverage.plan import MOST_ABOVE, PLAUSIBLE
from benchmarks.coverage.searching import GATED, HULL, NUMBERS
from benchmarks.coverage.tables import BCA, GATE, PRINTED, UNPAIRED, Row
from benchmarks.paired import find, markdown


def sized(rows: Sequence[Row], interval: str, sizes: Sequence[int]) -> list[Row]:
    """The rows of one interval at these numbers of seeds."""
    return [row for row in rows if row["interval"] == interval and row["n"] in sizes]


def covers_table(rows: Sequence[Row], interval: str, sizes: Sequence[int]) -> str:
    """A line for each quantity: its skewness and its cover at each size."""
    heads = ["", "skewness", *(f"n = {size}" for size in sizes), f"truth above, n = {sizes[-1]}"]
    lines = []
    for name in dict.fromkeys(row["quantity"] for row in rows):
        mine = [find(rows, quantity=name, interval=interval, n=size) for size in sizes]
        covers = [_cover(row) for row in mine]
        last = f"{mine[-1]['truth_above']:.3f}"
        skewness = mine[0]["skewness"]
        skewed = "–" if skewness is None else f"{skewness:.1f}"
        lines.append([f"`{name}`", skewed, *covers, last])
    return markdown(heads, lines)


def bca_table(rows: Sequence[Row], size: int) -> str:
    """Covers of BCa beside those of t, at one number of seeds."""
    lines = [
        [
            f"`{row['quantity']}`",
            f"{_cover(row)} ± {row['error']:.3f}",
            _cover(find(rows, quantity=row["quantity"], interval=PRINTED, n=size)),
        ]
        for row in rows
        if row["interval"] == BCA
    ]
    return markdown(["", f"BCa, n = {size}", "t, as printed"], lines)


def differences_table(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    """Covers of paired differences: printed, and without credit for pairing."""
    heads = ["difference of", *(f"n = {size}: as printed | unpaired too" for size in sizes)]
    lines = []
    for name in (*NUMBERS, HULL):
        cells = [f"`{name}`"]
        for size in sizes:
            usual, wider = (
                find(rows, quantity=f"{name}, difference", interval=interval, n=size)
                for interval in (PRINTED, UNPAIRED)
            )
            cells += [_cover(usual), f"{_cover(wider)} {_wider(wider, usual)}"]
        lines.append(cells)
    return markdown(" | ".join(heads).split(" | "), lines)


def rivals_table(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    """Cover of every interval, and its width over that of the printed one."""
    heads = ["", *(f"{name}, n = {size}" for size in sizes for name in INTERVALS)]
    lines = []
    for name in dict.fromkeys(row["quantity"] for row in rows):
        if name.startswith(HULL):
            continue
        cells = [f"`{name}`"]
        for size in sizes:
            usual = find(rows, quantity=name, interval=PRINTED, n=size)
            for interval in INTERVALS:
                row = find(rows, quantity=name, interval=interval, n=size)
                cells.append(f"{_cover(row)} {_wider(row, usual)}")
        lines.append(cells)
    return markdown(heads, lines)


def gated(rows: Sequence[Row], interval: str, sizes: Sequence[int]) -> list[Row]:
    """The rows of one interval on what `rigid gate` takes a limit for, and on the laws."""
    return [
        row
        for row in sized(rows, interval, sizes)
        if row["source"] == "law"
        or (row["quantity"].split(",")[0] in GATED and "difference" not in row["quantity"])
    ]


def gate_table(rows: Sequence[Row], sizes: Sequence[int]) -> str:
    """How often the truth lies above the upper end: of t, and of what `rigid gate` holds."""
    heads = ["", *(head for size in sizes for head in (f"n = {size}: t", "gate"))]
    lines = []
    for name in dict.fromkeys(row["quantity"] for row in gated(rows, GATE, sizes)):
        cells = [f"`{name}`"]
        for size in sizes:
            for interval in (PRINTED, GATE):
                cells.append(_above(find(rows, quantity=name, interval=interval, n=size)))
        lines.append(cells)
    return markdown(heads, lines)


def _above(row: Row) -> str:
    """How often the truth lies above the interval; bold where it is too often."""
    text = f"{row['truth_above']:.3f}"
    return f"**{text}**" if row["truth_above"] > MOST_ABOVE else text


def _cover(row: Row) -> str:
    """The cover; bold where it is too little."""
    text = f"{row['cover']:.3f}"
    return f"**{text}**" if row["cover"] < PLAUSIBLE[0] else text


def _wider(row: Row, usual: Row) -> str:
    """By how much an interval is wider than the printed one."""
    return f"(× {row['width'] / usual['width']:.2f})" if usual["width"] > 0 else "(× –)"

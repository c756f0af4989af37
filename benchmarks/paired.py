"""Numbers by search seed, compared in pairs: rows of a table, their words and their picture."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from benchmarks.study import COLOURS
from rigid.frontier.intervals import paired_difference, t_interval

Row = dict[str, Any]
BySeed = Mapping[int, float]
"""A share in [0, 1] for each search seed."""


def compared(
    label: Mapping[str, Any],
    number: str,
    mine: BySeed,
    *,
    reference: str = "",
    theirs: BySeed | None = None,
) -> Row:
    """A row: the mean over seeds and, where there is a reference, the paired difference to it.

    Both with 95 % t intervals over seeds; unknown values are None.

    Args:
        label: What the row is about.
        number: Which number it holds.
        mine: Its values.
        reference: With what it is compared.
        theirs: The values of that; only common seeds count in the difference.

    Example:
        >>> row = compared({"name": "b"}, "auc", {0: 0.4, 1: 0.6}, reference="a", theirs={1: 0.5})
        >>> row["value"], row["difference"].__round__(2), row["difference_low"], row["seeds"]
        (0.5, 0.1, None, 2)
    """
    values = list(mine.values())
    ends = t_interval(values) if values else None
    row: Row = {
        **label,
        "number": number,
        "value": sum(values) / len(values) if values else None,
        "low": None if ends is None else ends.low,
        "high": None if ends is None else ends.high,
        "reference": reference,
        "difference": None,
        "difference_low": None,
        "difference_high": None,
        "seeds": len(values),
    }
    if theirs is not None and set(mine) & set(theirs):
        found = paired_difference(mine, theirs)
        row["difference"] = found.mean
        if found.interval is not None:
            row |= {"difference_low": found.interval.low, "difference_high": found.interval.high}
    return row


def plain(label: Mapping[str, Any], number: str, value: float) -> Row:
    """A row of one value that no seed varies."""
    return {**compared(label, number, {}), "value": float(value)}


def find(rows: Iterable[Row], **wanted: Any) -> Row:
    """The one row with these values.

    Raises:
        ValueError: There is none, or more than one.
    """
    found = [row for row in rows if all(row[key] == value for key, value in wanted.items())]
    if len(found) != 1:
        raise ValueError(f"{len(found)} rows have {wanted}")
    return found[0]


def sign(row: Row) -> int:
    """1 where the difference lies above 0 with its whole interval, -1 below it, else 0."""
    low, high = row["difference_low"], row["difference_high"]
    if low is None:
        return 0
    return int(low > 0) - int(high < 0)


def value_text(row: Row) -> str:
    """The mean with its interval, as `0.520 [0.440, 0.600]`."""
    return _text(row["value"], row["low"], row["high"], ".3f")


def difference_text(row: Row) -> str:
    """The difference with its interval, as `+0.020 [-0.050, +0.090]`."""
    return _text(row["difference"], row["difference_low"], row["difference_high"], "+.3f")


def _text(value: float | None, low: float | None, high: float | None, form: str) -> str:
    if value is None:
        return "unknown"
    # Adding 0 after rounding turns -0.000 into 0.000.
    first, *ends = (f"{round(x, 3) + 0.0:{form}}" for x in (value, low, high) if x is not None)
    return f"{first} [{', '.join(ends)}]" if ends else first


def markdown(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of a README."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def forest(
    axis: Any,
    rows: Sequence[Row],
    labels: Sequence[str],
    *,
    of: str = "difference",
    shift: float = 0.0,
    legend: str | None = None,
) -> None:
    """Rows below each other, the first on top: a point and its interval each.

    Args:
        axis: Where to draw.
        rows: What to draw.
        labels: A name for each.
        of: `difference`, with a line at 0, or `value`.
        shift: Moves everything down, for a second set beside the first; takes the next colour.
        legend: What the legend calls them.
    """
    low, high = ("low", "high") if of == "value" else ("difference_low", "difference_high")
    colour = COLOURS[1 if shift else 0]
    axis.plot([], [], "o-", color=colour, markersize=4.5, label=legend)
    for place, row in enumerate(rows):
        if row[of] is None:
            continue
        if row[low] is not None:
            axis.plot([row[low], row[high]], [place + shift] * 2, color=colour, linewidth=1.2)
        axis.plot(row[of], place + shift, "o", color=colour, markersize=4.5)
    if of == "difference":
        axis.axvline(0, color="#5d6674", linewidth=0.8)
    axis.set_yticks(range(len(labels)), labels)
    axis.set_ylim(len(labels) - 0.4, -0.6)

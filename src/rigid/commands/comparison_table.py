"""The comparison of robots as text and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rigid.frontier.comparison import Number, Row
    from rigid.frontier.intervals import Interval, PairedDifference


def table(rows: Sequence[Row]) -> str:
    """The comparison as text: numbers with intervals, then differences to the first robot."""
    from rigid.frontier.comparison import HEADLINE_LEVEL, repeat_spread

    width = max(len(row.name) for row in rows)
    titles = {
        "worst_at": f"worst at ≥ {HEADLINE_LEVEL}",
        "hull_at": f"hull at {HEADLINE_LEVEL}",
        "auc_natural": "area over [0.8, 1]",
        "auc": "AUC",
    }
    lines = [f"{'robot':{width}}  {'success':>7}" + "".join(f"  {t:>20}" for t in titles.values())]
    for row in rows:
        success = row.frontier.data["canonical"]["success"]
        played = "–" if success is None else f"{success:.2f}"
        cells = (f"  {_number(row.numbers[key]):>20}" for key in titles)
        lines.append(f"{row.name:{width}}  {played:>7}" + "".join(cells))
    lines += ["", f"minus {rows[0].name}, on the search seeds that both have"]
    for row in rows[1:]:
        assert row.against is not None
        cells = (f"  {_difference(row.against[key]):>20}" for key in titles)
        lines.append(f"{row.name:{width}}  {'':7}" + "".join(cells))
    spreads = {key: repeat_spread(rows[0].numbers[key]) for key in titles}
    known = [f"{spread:.3f} for {titles[key]}" for key, spread in spreads.items() if spread]
    if known:
        lines += ["", f"a repeat of {rows[0].name} may differ by {', '.join(known)} (95 %)"]
    steadier = (
        f"{titles['hull_at']} tells robots apart more steadily: 95 % intervals of its differences "
        f"covered 94 to 96 %, those of {titles['worst_at']} 76 to 87 % (results/coverage)"
    )
    closing = "lower is more robust; estimates at this search power, not bounds"
    return "\n".join([*lines, steadier, closing])


def as_json(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """The comparison for JSON: every number with its interval, seeds and difference."""
    from rigid.frontier.comparison import repeat_spread

    return [
        {
            "robot": row.name,
            "directory": str(row.frontier.directory),
            "success": row.frontier.data["canonical"]["success"],
            "auc_paper_axis": row.frontier.data.get("auc_paper_axis"),
            **{
                key: {
                    "mean": number.mean,
                    "interval": number.interval,
                    "by_seed": dict(number.by_seed),
                    "repeat_spread": repeat_spread(number),
                    "minus_baseline": None if row.against is None else row.against[key]._asdict(),
                }
                for key, number in row.numbers.items()
            },
        }
        for row in rows
    ]


def _number(number: Number) -> str:
    return f"{number.mean:.3f}{_ends(number.interval)}"


def _difference(found: PairedDifference) -> str:
    return f"{found.mean:+.3f}{_ends(found.interval, '+.2f')}"


def _ends(interval: Interval | None, form: str = ".2f") -> str:
    return "" if interval is None else f" [{interval.low:{form}}, {interval.high:{form}}]"

"""The figure: paired differences by robot beside the limit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmarks.paired import Row, forest
from benchmarks.standard.pairing import Pairs
from benchmarks.standard.plan import DECIDING, LIMIT
from benchmarks.study import COLOURS, figure

_GREY = COLOURS[-1]
_ASIDE = 0.18
"""Seeds stand below their mean."""


def draw(path: Path, pairs: Sequence[Pairs], rows: Sequence[Row]) -> None:
    """Draws the deciding numbers.

    Args:
        path: The figure's file.
        pairs: Of all robots and of their means.
        rows: The table: one for each of `pairs`.
    """
    robots = list(dict.fromkeys(one.robot for one in pairs))
    size = (11.5, 1.3 + 0.5 * len(robots))
    with figure(path, columns=len(DECIDING), size=size) as axes:
        for axis, number in zip(axes, DECIDING, strict=True):
            for place, one in enumerate(one for one in pairs if one.number == number):
                axis.plot(
                    one.differences, [place + _ASIDE] * len(one.seeds), "o", color=_GREY,
                    markersize=3, label="search seeds" if place == 0 else None,
                )  # fmt: skip
            mine = [row for row in rows if row["number"] == number]
            labels = robots if number == DECIDING[0] else [""] * len(robots)
            forest(axis, mine, labels, legend="mean, 95 % interval")
            axis.axvline(
                -LIMIT, color=COLOURS[1], linewidth=0.9, linestyle="--", label=f"limit -{LIMIT:g}"
            )
            axis.set_title(number, fontsize=9)
            axis.set_xlabel("standard - paper, paired by search seed")
        axes[-1].legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))

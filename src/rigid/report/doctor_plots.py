"""The picture of each step of an examination, from the numbers of its verdict."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from rigid.report.figures import COLOURS, inline_figure

_WIDE: Final = 7.2
"""Width [inch]."""
_FAR = 6.0
"""Canonical deviations beyond which a feature is drawn as beyond the edge."""
_MOST = 24
"""Features that one picture shows."""


def plot_of(step: str, evidence: Mapping[str, Any]) -> str:
    """An `<svg>` element, or nothing where a step has no numbers to draw.

    Args:
        step: Of `rigid.doctor.verdict.TITLES`.
        evidence: Its numbers.
    """
    draw = _PLOTS.get(step)
    drawn = io.StringIO()
    if draw is not None and evidence:
        draw(drawn, evidence)
    return drawn.getvalue()


def _features(to: io.StringIO, evidence: Mapping[str, Any]) -> None:
    """What canonical play and other humans do to each feature, in canonical deviations."""
    if "spread" not in evidence:
        return
    names = evidence["names"][:_MOST]
    with inline_figure(to, size=(_WIDE, 1.3 + 0.24 * len(names))) as axis:
        kinds = list(evidence["spread"].items())
        for place, (kind, bands) in enumerate(kinds):
            offset = 0.22 * (place - (len(kinds) - 1) / 2)
            rows = np.arange(len(names)) + offset
            low, middle, high = (
                np.clip([band[key] for band in bands[:_MOST]], -_FAR, _FAR)
                for key in ("low", "median", "high")
            )
            colour = COLOURS[place]
            axis.hlines(rows, low, high, color=colour, linewidth=2.6, label=kind)
            axis.plot(middle, rows, "o", color=colour, markersize=3)
        axis.set_yticks(range(len(names)), [_short(name) for name in names])
        _plain(axis.get_yticklabels())
        axis.set_ylim(len(names) - 0.4, -0.6)
        axis.set_xlim(-_FAR * 1.03, _FAR * 1.03)
        axis.set_xlabel("canonical standard deviations from the canonical mean (5 to 95 %)")
        _legend_above(axis, len(kinds))


def _reward(to: io.StringIO, evidence: Mapping[str, Any]) -> None:
    """Returns of every human that was tried."""
    found = evidence["returns"]
    with inline_figure(to, size=(_WIDE, 0.9 + 0.4 * len(found))) as axis:
        for row, spread in enumerate(found.values()):
            colour = COLOURS[min(row, 3)]
            axis.hlines(row, spread["low"], spread["high"], color=colour, linewidth=3)
            axis.plot(spread["mean"], row, "o", color=colour, markersize=6)
        axis.set_yticks(range(len(found)), list(found))
        axis.set_ylim(len(found) - 0.5, -0.5)
        axis.set_xlabel("return: mean, and 5 to 95 % of episodes")


def _data(to: io.StringIO, evidence: Mapping[str, Any]) -> None:
    """How well judges do, by how many canonical episodes they had."""
    curve = evidence["curve"]
    if not curve:
        return
    sizes = [point["episodes"] for point in curve]
    with inline_figure(to, size=(_WIDE, 2.7)) as axis:
        for point in curve:
            shares = point["shares"]
            axis.plot([point["episodes"]] * len(shares), shares, ".", color=COLOURS[0], alpha=0.5)
        axis.plot(sizes, [point["mean"] for point in curve], "-o", color=COLOURS[0], markersize=4)
        mine = evidence["trained"]
        axis.axvline(mine, color=COLOURS[1], linewidth=1.5, linestyle="--")
        yours = evidence["episodes"]
        axis.annotate(
            f" you have {mine}" if mine == yours else f" {mine} of your {yours}",
            (mine, 0.02), xycoords=("data", "axes fraction"),
            color=COLOURS[1], ha="left" if mine < sizes[-1] else "right",
        )  # fmt: skip
        axis.set_xscale("log")
        axis.set_xticks(sizes, [str(size) for size in sizes])
        axis.minorticks_off()
        axis.set_xlabel("canonical episodes that a judge is trained on")
        axis.set_ylabel("held-out steps told right")


def _ends(to: io.StringIO, evidence: Mapping[str, Any]) -> None:
    """Naturalness and return of both ends."""
    with inline_figure(to, size=(_WIDE, 2.2)) as axis:
        ends = {"λ = 0": evidence["sabotage"], "λ = ∞": evidence["natural"]}
        for place, (name, end) in enumerate(ends.items()):
            values = end["naturalness"]
            colour = COLOURS[3 if place == 0 else 0]
            axis.barh(place, float(np.mean(values)), height=0.4, color=colour, alpha=0.75)
            axis.plot(values, [place] * len(values), "o", color=colour, markersize=4)
            axis.annotate(
                f" {name}: return {end['return']:.4g}{_success(end)}", (0.01, place),
                va="center", xytext=(0, 21), textcoords="offset points",
            )  # fmt: skip
        axis.axvline(evidence["natural_at_least"], color=COLOURS[1], linewidth=1.2, linestyle="--")
        axis.set_xlim(0, 1.02)
        axis.set_yticks([])
        axis.set_ylim(1.4, -0.85)
        axis.set_xlabel("naturalness (bar: mean, dots: seeds; dashed: what λ = ∞ should reach)")


def _scan(to: io.StringIO, evidence: Mapping[str, Any]) -> None:
    """Naturalness and harm by λ."""
    places, names = range(len(evidence["lambdas"])), evidence["lambdas"]
    means = [float(np.mean(values)) for values in evidence["naturalness"]]
    with inline_figure(to, size=(_WIDE, 2.7)) as axis:
        axis.plot(places, means, "-o", color=COLOURS[0], markersize=4, label="naturalness")
        for place, values in zip(places, evidence["naturalness"], strict=True):
            axis.plot([place] * len(values), values, ".", color=COLOURS[0], alpha=0.5)
        axis.plot(
            places, evidence["harm"], "--s", color=COLOURS[1], markersize=4,
            label="harm, as a share of that of λ = 0",
        )  # fmt: skip
        axis.set_xticks(places, [f"λ = {name}" if name == "0" else name for name in names])
        axis.set_xlabel("λ, the weight on staying natural")
        _legend_above(axis, 2)


def _legend_above(axis: Any, columns: int) -> None:
    axis.legend(
        loc="lower left",
        bbox_to_anchor=(0, 1.0),
        ncols=columns,
        borderaxespad=0.2,
        handlelength=1.4,
    )


def _success(end: Mapping[str, Any]) -> str:
    return "" if end["success"] is None else f", success {end['success']:.2f}"


def _short(name: str, most: int = 28) -> str:
    return name if len(name) <= most else f"{name[: most - 1]}…"


def _plain(texts: Any) -> None:
    """Names of others: a dollar is a dollar."""
    for text in texts:
        text.set_parse_math(False)


_PLOTS: dict[str, Callable[[io.StringIO, Mapping[str, Any]], None]] = {
    "features": _features, "reward": _reward, "data": _data, "ends": _ends, "scan": _scan,
}  # fmt: skip

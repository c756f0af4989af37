"""The paper's figures of its user studies: people under the frontier, preferences, scores."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from rigid.report.figures import COLOURS, figure, inline_figure
from rigid.study.analysis.dominance import hull_height
from rigid.study.analysis.judgements import ChoiceFindings, Judged, ScoreFindings
from rigid.study.analysis.placing import Placed
from rigid.study.analysis.reading import MeasuredRobot
from rigid.study.analysis.whole import Analysis
from rigid.study.analysis.wording import AXIS_OF, QUESTIONS
from rigid.study.records import DeviceClass

SIZE: Final = (6.4, 4.2)
"""Of a figure [inch]."""
MARKERS = {"desktop": "o", "touch": "s", "vr": "^", "scripted": "X"}
_GREY, _FAINT = "#5d6674", "#9aa0ab"
_FILE = re.compile(r"[^A-Za-z0-9_-]+")

Draw = Callable[[Any], None]


def drawings(analysis: Analysis) -> list[tuple[str, Draw]]:
    """Every figure: the name of its file, and what draws it on axes."""
    found: list[tuple[str, Draw]] = []
    for key in analysis.met:
        placed = [p for p in analysis.placed if p.player.robot == key]
        claims = {c.device: c.claim for c in analysis.controls if c.robot == key}
        found.append((f"people-{key}", people_figure(analysis.robots[key], placed, claims)))
    for judged in analysis.judged:
        draw = (
            _preference(judged, analysis)
            if judged.question == "correspondence"
            else _scores(judged)
        )
        found.append((f"{judged.question}-{Path(judged.pairs).stem}", draw))
    return [(_FILE.sub("-", name), draw) for name, draw in found]


def draw_all(analysis: Analysis, out: Path) -> list[Path]:
    """Writes every figure as SVG and PDF."""
    written = []
    for name, draw in drawings(analysis):
        for ending in (".svg", ".pdf"):
            path = out / f"{name}{ending}"
            with figure(path, size=SIZE) as axis:
                draw(axis)
            written.append(path)
    return written


def inline(draw: Draw) -> str:
    """A figure as an `<svg>` element."""
    drawn = io.StringIO()
    with inline_figure(drawn, size=SIZE) as axis:
        draw(axis)
    return drawn.getvalue()


def people_figure(
    robot: MeasuredRobot, placed: Sequence[Placed], claims: Mapping[DeviceClass, bool]
) -> Draw:
    """Players under the frontier of their robot.

    Args:
        robot: The robot.
        placed: Its players; those without a place are left out.
        claims: Whether anything may be claimed of people with a kind of device; default no.
    """
    placed = [one for one in placed if one.unplaced is None]

    def draw(axis: Any) -> None:
        _frontier(axis, robot)
        roles = list(dict.fromkeys(p.player.role for p in placed if not p.player.scripted))
        groups: dict[tuple[DeviceClass, str], list[Placed]] = {}
        for one in placed:
            role = "" if one.player.scripted else one.player.role
            groups.setdefault((one.player.device, role), []).append(one)
        for (device, role), mine in groups.items():
            colour = _GREY if device == "scripted" else COLOURS[(1 + roles.index(role)) % 5]
            filled = device == "scripted" or claims.get(device, False)
            _players(axis, mine, device, role, colour, filled=filled)
        axis.set_xlabel("naturalness (of players: at most, by the strictest referee)")
        axis.set_ylabel("adversarialness")
        axis.set_xlim(-0.02, 1.02)
        axis.set_ylim(-0.02, 1.02)
        _legend(axis)

    return draw


def _frontier(axis: Any, robot: MeasuredRobot) -> None:
    """The adversaries, the steps that they dominate, and their hull."""
    colour = COLOURS[0]
    order = np.argsort(robot.front.naturalness)
    x = robot.front.naturalness[order]
    height = np.maximum.accumulate(robot.front.adversarialness[order][::-1])[::-1]
    edges = np.concatenate([[0.0], x])
    axis.fill_between(edges, np.append(height[0], height), step="pre", color=colour, alpha=0.08,
                      linewidth=0)  # fmt: skip
    axis.step(edges, np.append(height[0], height), where="pre", color=colour, linewidth=1.6,
              label="frontier: below, dominated")  # fmt: skip
    hull = [hull_height(robot.front, at) for at in edges]
    axis.plot(edges, hull, "--", color=colour, linewidth=0.9, label="its hull")
    axis.plot(robot.front.naturalness, robot.front.adversarialness, ".", color=colour,
              markersize=4, alpha=0.55, label="adversaries and canonical play")  # fmt: skip


def _players(
    axis: Any, mine: Sequence[Placed], device: DeviceClass, role: str, colour: str, *, filled: bool
) -> None:
    x = np.array([p.naturalness for p in mine], dtype=float)
    y = np.array([p.adversarialness for p in mine], dtype=float)
    ends = np.array([[p.naturalness_se or 0, p.adversarialness_se or 0] for p in mine]).T
    scripted = device == "scripted"
    label = "scripted, no person" if scripted else f"{role}, {device}"
    if not filled:
        label = f"{label} (no claim)"
    axis.errorbar(
        x, y, xerr=ends[0], yerr=ends[1], fmt="none", ecolor=colour, elinewidth=0.7, alpha=0.6
    )
    axis.scatter(
        x, y, marker=MARKERS[device], s=34, facecolors=colour if filled else "white",
        edgecolors=colour, linewidths=1.1, label=label, zorder=3,
    )  # fmt: skip
    if scripted:
        for one, place in zip(mine, zip(x, y, strict=True), strict=True):
            axis.annotate(
                one.player.name, place, xytext=(5, 4), textcoords="offset points", fontsize=7,
                color=colour, parse_math=False,
            )  # fmt: skip


def _preference(judged: Judged, analysis: Analysis) -> Draw:
    rows: list[tuple[str, ChoiceFindings]] = []
    for label, found in (("everybody", judged.everybody), ("attentive", judged.attentive)):
        if isinstance(found, ChoiceFindings):
            rows.append((label, found))
    rows.reverse()  # From below.
    margin = analysis.settings.margin

    def draw(axis: Any) -> None:
        axis.set_axisbelow(True)
        axis.axvspan(0.5 - margin, 0.5 + margin, color=COLOURS[2], alpha=0.15, linewidth=0,
                     label=f"equivalence margin, ± {margin:g}")  # fmt: skip
        axis.axvline(0.5, color=COLOURS[2], linewidth=1)
        for place, (_, found) in enumerate(rows):
            preference = found.preference
            axis.barh(place, preference.share.mean, height=0.42, color=COLOURS[0], alpha=0.75)
            raters = np.array(found.by_rater)
            lift = np.linspace(-0.16, 0.16, len(raters)) if len(raters) > 1 else np.zeros(1)
            axis.plot(raters, place + lift, "o", color="white", markeredgecolor=_GREY,
                      markersize=4, label="each rater" if place == 0 else None)  # fmt: skip
            for ends, width, label in (
                (preference.interval, 1.2, "95 % interval"),
                (preference.interval_of_test, 3.2, "90 %, of the test"),
            ):
                if ends is not None:
                    axis.plot(ends, [place + 0.32] * 2, color="#1c1d21", linewidth=width,
                              label=label if place == 0 else None)  # fmt: skip
        axis.set_yticks(range(len(rows)), [label for label, _ in rows])
        axis.set_xlim(0, 1)
        axis.set_ylim(-0.6, len(rows) - 0.2)
        axis.set_xlabel("share that chose the recorded motion as closer to the reference")
        _legend(axis)

    return draw


def _scores(judged: Judged) -> Draw:
    found = judged.everybody
    assert isinstance(found, ScoreFindings)
    axis_name = AXIS_OF[judged.question]
    scores = found.scores

    def draw(axis: Any) -> None:
        level = getattr(scores, axis_name)
        for pair in np.unique(scores.pair):
            ends = []
            for second in (0, 1):
                mine = (scores.pair == pair) & (scores.second == second)
                if mine.any():
                    ends.append((level[mine].mean(), scores.score[mine].mean()))
            axis.plot(*zip(*ends, strict=True), "-o", color=_FAINT, markersize=3, linewidth=0.7)
        for second, (estimate, colour) in enumerate(
            zip(found.levels, (COLOURS[0], COLOURS[1]), strict=True)
        ):
            if not estimate.answers:
                continue
            at = float(level[scores.second == second].mean())
            low, high = estimate.interval or (estimate.mean, estimate.mean)
            reach = [[estimate.mean - low], [high - estimate.mean]]
            label = f"{'more' if second else 'less'} {axis_name}, mean and 95 %"
            axis.errorbar(at, estimate.mean, yerr=reach, fmt="D", color=colour, markersize=7,
                          capsize=4, zorder=3, label=label)  # fmt: skip
        axis.set_xlabel(f"{axis_name} of the shown episode")
        axis.set_ylabel(
            "danger − goal" if judged.question == "danger" else "closeness to the canonical motion"
        )
        axis.set_xlim(-0.02, 1.02)
        axis.set_title(
            f"{QUESTIONS[judged.question]}: a line is a pair, mean of raters", fontsize=9
        )
        _legend(axis)

    return draw


def _legend(axis: Any) -> None:
    legend = axis.legend(fontsize=7, loc="best")
    for text in legend.get_texts():
        text.set_parse_math(False)  # Names of others: a dollar is a dollar.

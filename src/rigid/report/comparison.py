"""The page of a comparison: curves, tables and a link to the report of each robot, in one file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from urllib.parse import quote

from rigid.compute.return_range import spoken_range
from rigid.compute.run.directory import RunDirectory
from rigid.frontier.comparison import numbers_of
from rigid.frontier.intervals import Interval
from rigid.frontier.methods import Estimate
from rigid.frontier.result import Frontier
from rigid.frontier.standings import TITLES, Standing
from rigid.frontier.successes import Success
from rigid.report.curves import inline_curves
from rigid.report.plain_page import plain_page, safe, table

_TEMPLATE = resources.files("rigid.report") / "comparison.html"
_UNKNOWN = "–"


def comparison_page(standings: Sequence[Standing], notes: Sequence[str], *, at: Path) -> str:
    """The page as text.

    Args:
        standings: The first is the baseline.
        notes: Sentences on how to read it.
        at: Where the page will lie; links to reports are relative to that.
    """
    everyone = [frontier for standing in standings for frontier in standing.robots]
    names = [standing.method.name for standing in standings]
    stamps = dict.fromkeys(str(f.data["stamp"]) for f in everyone if f.data.get("stamp"))
    return plain_page(
        _TEMPLATE,
        title=f"{_listed(names)} on {everyone[0].data['task']} · RIGID",
        facts=safe(f"{len(everyone)} robots, preset {everyone[0].data['preset']}"),
        stamp="".join(f'<p class="stamp">{safe(stamp)}</p>' for stamp in stamps),
        curves=inline_curves({s.method.name: s.robots for s in standings}),
        caption=safe(_caption(standings)),
        table=_methods(standings),
        differences=_differences(standings),
        notes="".join(f"<li>{safe(note)}.</li>" for note in notes),
        robots=_robots(standings, at),
    )


def _caption(standings: Sequence[Standing]) -> str:
    behind = (
        "thin: its robots" if any(len(s.robots) > 1 for s in standings)
        else "shaded: 95 % over search seeds at each naturalness, where few robots are shown"
    )  # fmt: skip
    return (
        f"Mean of the frontiers of each row of the table ({behind}) and the adversaries found. "
        "Lower is more robust. Adversarialness is "
        f"{spoken_range(standings[0].robots[0].data)}, the same for all."
    )


def _methods(standings: Sequence[Standing]) -> str:
    """The paper's table with the headline numbers."""
    asked = any(standing.unseen is not None for standing in standings)
    heads = [
        "method", "AUC ↓", "success ↑", *(["success, unseen humans ↑"] if asked else []),
        *(f"{TITLES[key]} ↓" for key in ("worst_at", "hull_at", "auc_natural")), "robots",
        "search seeds",
    ]  # fmt: skip
    rows = []
    for standing in standings:
        numbers = standing.method.numbers
        rows.append([
            safe(standing.method.name), _cell(numbers["auc"]), _cell(standing.success, ".2f"),
            *([_cell(standing.unseen, ".2f")] if asked else []),
            *(_cell(numbers[key]) for key in ("worst_at", "hull_at", "auc_natural")),
            str(standing.method.robots), str(standing.method.seeds),
        ])  # fmt: skip
    return table(heads, rows)


def _differences(standings: Sequence[Standing]) -> str:
    if len(standings) < 2:
        return ""
    rows = [
        [
            safe(standing.method.name),
            *(_cell(standing.method.against[key], "+.3f") for key in TITLES),
        ]
        for standing in standings
        if standing.method.against is not None
    ]
    heads = ["method", *TITLES.values()]
    title = f"<h2>Minus {safe(standings[0].method.name)}</h2>"
    return f"{title}\n{table(heads, rows)}"


def _robots(standings: Sequence[Standing], at: Path) -> str:
    keys = ("auc", "worst_at", "hull_at", "auc_natural")
    rows = []
    for standing in standings:
        for number, frontier in enumerate(standing.robots, start=1):
            name, several = standing.method.name, len(standing.robots) > 1
            data, numbers = frontier.data, numbers_of(frontier)
            success = data["canonical"]["success"]
            rows.append([
                safe(f"{name} {number}" if several else name), safe(str(data["robot"])),
                safe(str(data.get("human", _UNKNOWN))), f"{numbers['auc'].mean:.3f}",
                _UNKNOWN if success is None else f"{success:.2f}",
                *(f"{numbers[key].mean:.3f}" for key in keys[1:]), _link(frontier, at),
            ])  # fmt: skip
    heads = ("", "robot", "synthetic human", "AUC ↓", "success ↑",
             *(f"{TITLES[key]} ↓" for key in keys[1:]), "report")  # fmt: skip
    return table(heads, rows, text=(1, 2))


def _link(frontier: Frontier, at: Path) -> str:
    """To the robot's report, from where the page lies; no link to what is not there."""
    report = RunDirectory(frontier.directory).report
    if not report.exists():
        return "none"
    way = os.path.relpath(report.resolve(), at.resolve().parent)
    return f'<a href="{safe(quote(Path(way).as_posix()))}">report.html</a>'


def _cell(found: Estimate | Success | None, form: str = ".3f") -> str:
    if found is None:
        return _UNKNOWN
    ends: Interval | None = found.interval
    shown = f"{found.mean:{form}}"
    return (
        shown if ends is None else f"{shown}<small>{ends.low:{form}} to {ends.high:{form}}</small>"
    )


def _listed(names: Sequence[str]) -> str:
    """Some names, so that a title stays one.

    Example:
        >>> _listed(["a"]), _listed(["a", "b", "c"]), _listed(["a", "b", "c", "d", "e", "f"])
        ('a', 'a, b, c', 'a, b, c and 3 others')
    """
    if len(names) <= 4:
        return ", ".join(names)
    return f"{', '.join(names[:3])} and {len(names) - 3} others"

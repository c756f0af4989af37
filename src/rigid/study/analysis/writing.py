"""What an analysis leaves on disk: `analysis.json`, `placed.csv`, figures and the page."""

from __future__ import annotations

import csv
import dataclasses
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rigid.files import json_text, write_atomically
from rigid.frontier.comparison import numbers_of
from rigid.frontier.intervals import Interval
from rigid.study.analysis.figures import draw_all
from rigid.study.analysis.page import study_page
from rigid.study.analysis.placing import Placed
from rigid.study.analysis.reading import MeasuredRobot
from rigid.study.analysis.whole import Analysis
from rigid.study.analysis.wording import notes, sentences

FORMAT_VERSION = 1
_COLUMNS = (
    "participant", "kind", "name", "role", "robot", "device", "episodes", "naturalness_at_most",
    "naturalness_se", "naturalness_on_device_at_most", "naturalness_of_practice_at_most", "referee",
    "adversarialness", "adversarialness_se", "success", "frontier_height", "above_frontier",
    "above_frontier_clearly", "hull_height",
    "above_frontier_on_device", "episodes_above", "unplaced",
)  # fmt: skip


def write_analysis(analysis: Analysis, out: Path) -> list[Path]:
    """Writes everything into the directory `out`; returns what was written, the page last."""
    out.mkdir(parents=True, exist_ok=True)
    figures = draw_all(analysis, out)
    files = {
        "analysis.json": json_text(as_json(analysis), indent=1) + "\n",
        "placed.csv": placed_csv(analysis.placed),
        "study.html": study_page(analysis),
    }
    for name, text in files.items():
        write_atomically(out / name, text.encode())
    first, second, page = (out / name for name in files)
    return [first, second, *figures, page]


def as_json(analysis: Analysis) -> dict[str, Any]:
    """The whole analysis as JSON; what is undefined is null."""
    return {
        "format": FORMAT_VERSION,
        "title": analysis.title,
        "task": analysis.task,
        "settings": analysis.settings.describe(),
        "registered": analysis.registered,
        "people": dict(analysis.people),
        "scripted": analysis.scripted,
        "withdrawn": analysis.withdrawn,
        "robots": {key: _robot(robot) for key, robot in analysis.robots.items()},
        "unmeasured": list(analysis.unmeasured),
        "findings": sentences(analysis),
        "notes": notes(analysis),
        "counts": [plain(count) for count in analysis.counts],
        "controls": [plain(control) for control in analysis.controls],
        "placed": [row_of(placed) for placed in analysis.placed],
        "judged": [plain(judged) for judged in analysis.judged],
        "order": plain(analysis.order),
    }


def placed_csv(placed: Sequence[Placed]) -> str:
    """A line for each player, robot and kind of device."""
    text = io.StringIO()
    table = csv.DictWriter(text, _COLUMNS, extrasaction="ignore", lineterminator="\n")
    table.writeheader()
    table.writerows({k: "" if v is None else v for k, v in row_of(one).items()} for one in placed)
    return text.getvalue()


def row_of(placed: Placed) -> dict[str, Any]:
    """One player as JSON."""
    player = placed.player
    return {
        "participant": player.code,
        "kind": "scripted" if player.scripted else "person",
        "name": player.name,
        "role": player.role,
        "robot": player.robot,
        "device": player.device,
        "episodes": len(player.played),
        "naturalness_at_most": placed.naturalness,
        "naturalness_se": placed.naturalness_se,
        "naturalness_on_device_at_most": placed.on_device,
        "naturalness_of_practice_at_most": placed.benign,
        "referee": placed.referee,
        "adversarialness": placed.adversarialness,
        "adversarialness_se": placed.adversarialness_se,
        "adversarialness_of_episodes": list(placed.harm),
        "success": placed.success,
        "frontier_height": placed.height,
        "above_frontier": placed.above,
        "above_frontier_clearly": placed.above_clearly,
        "hull_height": placed.hull,
        "above_frontier_on_device": placed.above_on_device,
        "episodes_above": placed.episodes_above,
        "unplaced": placed.unplaced,
    }


def plain(value: Any) -> Any:
    """Any finding as JSON: intervals as pairs, NaN as null, arrays left out."""
    fields = _fields(value)
    if fields is not None:
        return {name: plain(inner) for name, inner in fields.items() if name != "scores"}
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _fields(value: Any) -> Mapping[Any, Any] | None:
    """The fields of a record, None for all else."""
    if isinstance(value, Mapping):
        return value
    if isinstance(value, Interval):  # Two ends, without names.
        return None
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return dict(value._asdict())
    return None


def _robot(robot: MeasuredRobot) -> dict[str, Any]:
    """What runs say of a robot."""
    numbers = numbers_of(robot.frontiers[0])
    return {
        "robot": robot.frontiers[0].data["robot"],
        "runs": [str(run.directory) for run in robot.runs],
        "referees": len(robot.panels),
        "numbers": {
            name: {"mean": number.mean, "interval": plain(number.interval)}
            for name, number in numbers.items()
        },
    }

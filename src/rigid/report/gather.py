"""From a run directory to what the report shows.

Nothing that a run directory names is imported; the task is looked up among RIGID's own, and without
it the report simply has no replays.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rigid.compute.checkpoint import load_arrays
from rigid.compute.run_directory import RunDirectory, read_settings
from rigid.errors import UserError
from rigid.files import read_bytes
from rigid.frontier.result import Frontier, load_frontier, measured_points
from rigid.frontier.statistics import interval_band, sound_points_by_seed
from rigid.report.build import build_report
from rigid.report.discriminators import discriminators
from rigid.report.poses import encode_poses
from rigid.tasks.protocol import Task
from rigid.tasks.registry import task_from_description

_LEARNING = {
    "return": "mean_return",
    "score_canonical": "score_canonical",
    "score_adversary": "score_adversary",
    "accuracy_canonical": "accuracy_canonical",
    "accuracy_adversary": "accuracy_adversary",
    "entropy": "entropy",
}
_BLAME = ("solvable", "verdict", "regret")
_ID = re.compile(r"[\w-]+", re.ASCII)
_GRID = 101
"""Places on the x axis at which the interval band is drawn."""


def write_report(directory: Path, out: Path | None = None) -> Path:
    """Writes the report of a finished run and returns its path (`report.html` in the run).

    Raises:
        UserError: The run is not finished, a file of it is damaged, or `out` cannot be written.
    """
    run = RunDirectory(directory)
    frontier = load_frontier(directory)
    return build_report(gather(frontier, read_settings(run)), out or run.report)


def gather(frontier: Frontier, settings: Mapping[str, Any]) -> dict[str, Any]:
    """The report's `Payload`, read from the run directory of `frontier`."""
    described = settings["identity"].get("task")
    task = task_from_description(described) if isinstance(described, Mapping) else None
    return {
        "frontier": {**frontier.data, "points": _blamed(frontier)},
        "settings": settings,
        "stamp": frontier.data.get("stamp"),
        "band": band(frontier),
        "passive": frontier.data.get("passive"),
        "learning": {
            point["id"]: learning_curves(_folder(frontier, point)) for point in frontier.points
        },
        "scene": None if task is None else task.scene(),
        "replays": None if task is None else replays(frontier, task),
        "discriminators": discriminators(frontier, task),
    }


def _blamed(frontier: Frontier) -> list[dict[str, Any]]:
    """The points, with what `rigid blame` said of them where it was asked."""
    path = frontier.directory / "blame.json"
    cure = "delete it and run `rigid blame` again"
    try:
        said = json.loads(read_bytes(path, cure=cure)) if path.exists() else {}
        said = dict(said.items())  # Fails for what is no table.
        return [
            {**point, **{key: said[point["id"]][key] for key in _BLAME if point["id"] in said}}
            for point in frontier.points
        ]
    except (ValueError, KeyError, TypeError, AttributeError):
        raise UserError(f"{path} is damaged: {cure}") from None


def band(frontier: Frontier) -> dict[str, Any]:
    """Mean and interval of the per-seed hulls on a grid of naturalness."""
    seeds = [int(seed) for seed in frontier.data["auc_by_seed"]]
    grid = np.linspace(0.0, 1.0, _GRID)
    anchor = frontier.data["canonical"]["adversarialness"]
    by_seed = sound_points_by_seed(measured_points(frontier.points), seeds)
    found = interval_band(by_seed, dict.fromkeys(seeds, anchor), grid)
    return {
        "x": grid.tolist(),
        "mean": found.mean.tolist(),
        "low": None if found.low is None else found.low.tolist(),
        "high": None if found.high is None else found.high.tolist(),
    }


def learning_curves(adversary: Path) -> dict[str, list[float]]:
    """One adversary's training, iteration by iteration, from its directory; known ones only."""
    path = adversary / "metrics.jsonl"
    cure = "measure again to get its learning curves back"
    try:
        rows = [json.loads(line) for line in read_bytes(path, cure=cure).splitlines()]
        curves = {name: [row[key] for row in rows] for name, key in _LEARNING.items()}
        known = {name: values for name, values in curves.items() if None not in values}
        numbers = {name: [float(value) for value in values] for name, values in known.items()}
        return {"iteration": [float(row["iteration"]) for row in rows], **numbers}
    except (ValueError, KeyError, TypeError):
        raise UserError(f"{path} is damaged: {cure}") from None


def replays(frontier: Frontier, task: Task) -> dict[str, Any] | None:
    """Worst and median episode of every adversary, and canonical motion from the same starts.

    None when the task shows nothing of an episode.
    """
    shown: dict[str, Any] = {"canonical": {}}
    for point in frontier.points:
        path = _folder(frontier, point) / "episodes.npz"
        arrays = load_arrays(path, cure="measure again to get its replays back")
        if arrays["snapshots"].shape[-1] == 0:
            return None
        entry = {}
        for number, kind in enumerate(("worst", "median")):
            episode = arrays["shown"][number]
            seed = int(arrays["seeds"][episode])
            entry[kind] = {
                **_motion(task, arrays["snapshots"][number]),
                **_ending(task, seed, arrays["returns"][episode], arrays["outcome"][episode]),
            }
            if str(seed) not in shown["canonical"]:
                ended = arrays["canonical_returns"][number], arrays["canonical_outcome"][number]
                shown["canonical"][str(seed)] = {
                    **_motion(task, arrays["canonical_snapshots"][number]),
                    **_ending(task, seed, *ended),
                }
        shown[point["id"]] = entry
    return shown


def _motion(task: Task, snapshots: np.ndarray) -> dict[str, Any]:
    """One replay, with its poses packed for the page."""
    shown = dict(task.replay(snapshots))
    if "poses" in shown:
        shown["poses"] = encode_poses(shown["poses"])
    return shown


def _folder(frontier: Frontier, point: Mapping[str, Any]) -> Path:
    """Where an adversary lies; a stranger's id leads nowhere else."""
    name = str(point["id"])
    if not _ID.fullmatch(name):
        where = frontier.directory / "frontier.json"
        raise UserError(f"{where} has a point {name!r}, which is no id such as s0-r1-l1")
    return frontier.directory / "adversaries" / name


def _ending(task: Task, seed: int, total: np.number, outcome: np.number) -> dict[str, Any]:
    """How an episode ended, under the report's names."""
    return {
        "seed": seed,
        "return": round(float(total), 2),
        "outcome": task.outcome_names[int(outcome)],
    }

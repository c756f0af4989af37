"""From a run directory to what the report shows.

Nothing that a run directory names is imported; the task is looked up among RIGID's own, and without
it the report simply has no replays.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rigid.compute.run.checkpoint import load_arrays
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.errors import UserError
from rigid.files import read_bytes
from rigid.frontier.comparison import HEADLINE_LEVEL
from rigid.frontier.result import Frontier, load_frontier, measured_points
from rigid.frontier.statistics import interval_band, sound_points_by_seed
from rigid.report.build import build_report
from rigid.report.discriminators import discriminators
from rigid.report.episodes import Episode, goal_of, read_episode
from rigid.report.failure_rules import classify
from rigid.report.failures import group, write_failures
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
EPISODES = ("worst", "median")
"""Those of an adversary's scored episodes that are kept whole, in their order in the file."""
_GRID = 101
"""Places on the x axis at which the interval band is drawn."""


def write_report(
    directory: Path, out: Path | None = None, *, drawn: Callable[[int], None] = lambda _: None
) -> Path:
    """Writes the report of a finished run and returns its path (`report.html` in the run).

    Beside it goes `failures.json`, unless the report goes elsewhere.

    Args:
        directory: Of the run.
        out: Where to write it instead.
        drawn: Told of adversaries whose replays are ready, one at a time.

    Raises:
        UserError: The run is not finished, a file of it is damaged, or `out` cannot be written.
    """
    run = RunDirectory(directory)
    frontier = load_frontier(directory)
    payload = gather(frontier, read_settings(run), drawn)
    path = build_report(payload, out or run.report)
    if out is None:
        write_failures(frontier, payload["failures"])
    return path


def gather(
    frontier: Frontier,
    settings: Mapping[str, Any],
    drawn: Callable[[int], None] = lambda _: None,
) -> dict[str, Any]:
    """The report's `Payload`, read from the run directory of `frontier`; see `write_report`."""
    task = task_of(settings)
    shown = None if task is None else replays(frontier, task, drawn)
    scene = None if task is None else task.scene()
    return {
        "frontier": {**frontier.data, "points": _blamed(frontier)},
        "settings": settings,
        "stamp": frontier.data.get("stamp"),
        "band": band(frontier),
        "passive": frontier.data.get("passive"),
        "lacking": frontier.lacking_at(HEADLINE_LEVEL),
        "learning": {
            point["id"]: learning_curves(_folder(frontier, point)) for point in frontier.points
        },
        "scene": scene,
        "replays": shown,
        "discriminators": discriminators(frontier, task),
        "failures": group(frontier.points, shown, goal_of(scene)),
    }


def task_of(settings: Mapping[str, Any]) -> Task | None:
    """The task of a run's settings; None where it is not one of RIGID's own."""
    described = settings["identity"].get("task")
    return task_from_description(described) if isinstance(described, Mapping) else None


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


def replays(
    frontier: Frontier, task: Task, drawn: Callable[[int], None] = lambda _: None
) -> dict[str, Any] | None:
    """Worst and median episode of every adversary, and canonical motion from the same starts.

    Each episode of an adversary comes with its `failure`. None when the task shows nothing of an
    episode.
    """
    shown: dict[str, Any] = {"canonical": {}}
    scene, beside = task.scene(), dict[str, Episode | None]()
    for point in frontier.points:
        arrays = stored_episodes(frontier, point)
        if arrays["snapshots"].shape[-1] == 0:
            return None
        entry = {}
        for kind in EPISODES:
            played = episode(task, arrays, kind)
            seed = str(played["seed"])
            if seed not in beside:
                canonical = episode(task, arrays, kind, canonical=True)
                shown["canonical"][seed] = _packed(canonical)
                beside[seed] = read_episode(scene, canonical)
            faulted = arrays["faulted"][arrays["shown"][EPISODES.index(kind)]] > 0
            seen = None if faulted else read_episode(scene, played)
            entry[kind] = {**_packed(played), "failure": classify(seen, beside[seed])}
        shown[point["id"]] = entry
        drawn(1)
    return shown


def stored_episodes(frontier: Frontier, point: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """What was kept of the episodes that an adversary was scored on.

    Raises:
        UserError: The file is missing or damaged.
    """
    path = _folder(frontier, point) / "episodes.npz"
    return load_arrays(path, cure="measure again to get its replays back")


def episode(
    task: Task, arrays: Mapping[str, np.ndarray], kind: str, *, canonical: bool = False
) -> dict[str, Any]:
    """The replay of one stored episode, with poses as an array (frames, bodies, 7).

    Args:
        task: The one that was played.
        arrays: `stored_episodes`, with snapshots.
        kind: One of `EPISODES`.
        canonical: The synthetic human instead, from the same start.
    """
    number = EPISODES.index(kind)
    which = arrays["shown"][number]
    if canonical:
        total, outcome = arrays["canonical_returns"][number], arrays["canonical_outcome"][number]
    else:
        total, outcome = arrays["returns"][which], arrays["outcome"][which]
    motion = task.replay(arrays["canonical_snapshots" if canonical else "snapshots"][number])
    return {**motion, **_ending(task, int(arrays["seeds"][which]), total, outcome)}


def _packed(replay: dict[str, Any]) -> dict[str, Any]:
    """The replay with its poses packed for the page."""
    return {**replay, "poses": encode_poses(replay["poses"])} if "poses" in replay else replay


def _folder(frontier: Frontier, point: Mapping[str, Any]) -> Path:
    """Where an adversary lies."""
    return RunDirectory(frontier.directory).adversary(point["id"])


def _ending(task: Task, seed: int, total: np.number, outcome: np.number) -> dict[str, Any]:
    """How an episode ended, under the report's names."""
    return {
        "seed": seed,
        "return": round(float(total), 2),
        "outcome": task.outcome_names[int(outcome)],
    }

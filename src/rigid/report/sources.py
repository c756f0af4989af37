"""Which episode to show: a stored one of a run's adversaries, or a new one of any pair."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.errors import UserError
from rigid.frontier.result import Frontier, load_frontier, measured_points
from rigid.policies.opening import SAFE, Opening
from rigid.report.gather import episode, stored_episodes
from rigid.report.motion import Shown, read_motion
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task, task_from_description

BANDS: Final = ((0.8, 1.01), (0.4, 0.8), (0.0, 0.4))
"""Naturalness of what is picked by itself, lower end included: natural by the least level of the
headline, doubtful, and unnatural. Ours."""


class Run(NamedTuple):
    """A finished measurement whose episodes can be drawn."""

    frontier: Frontier
    task: Task
    scene: Mapping[str, Any]


def open_run(directory: Path, task: str | None = None) -> Run:
    """A run and the task that it was made with.

    Args:
        directory: A finished run directory.
        task: A registered name; None for the task that the run names, one of RIGID's own: nothing
            that a run directory names is imported.

    Raises:
        UserError: The run is not finished, its task is unknown, or a task without a picture.
    """
    frontier = load_frontier(directory)
    described = read_settings(RunDirectory(directory))["identity"].get("task")
    known = isinstance(described, Mapping)
    found = task_from_description(described) if known and task is None else None
    if found is None:
        if task is None:
            name = described.get("name") if known else described
            raise UserError(
                f"{directory} was measured on {name!r}, which is none of RIGID's own tasks: name "
                "it with --task if you trust it"
            )
        found = make_task(task, **(described.get("parameters", {}) if known else {}))
    return Run(frontier, found, scene_of(found))


def scene_of(task: Task) -> Mapping[str, Any]:
    """What to draw of a task.

    Raises:
        UserError: Nothing.
    """
    scene = task.scene()
    if scene is None or not scene["geoms"]:
        raise UserError(f"task {task.name!r} has no picture: only tasks with a scene can be drawn")
    return scene


def worst_by_band(points: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The most adversarial sound point of each of `BANDS` that has one, the most natural first.

    Raises:
        UserError: No point is sound.
    """
    sound = [
        point
        for point, measured in zip(points, measured_points(points), strict=True)
        if measured.is_sound and point["adversarialness"] is not None
    ]
    bands = ([p for p in sound if low <= p["naturalness"] < high] for low, high in BANDS)
    found = [
        max(band, key=lambda p: (p["adversarialness"], p["naturalness"])) for band in bands if band
    ]
    if not found:
        raise UserError("this run has no adversary whose physics held: there is nothing to show")
    return found


def point_called(frontier: Frontier, name: str) -> Mapping[str, Any]:
    """The point of that id.

    Raises:
        UserError: There is none.
    """
    known = {str(point["id"]): point for point in frontier.points}
    if name not in known:
        raise UserError(f"--point {name!r} is none of this run's: {', '.join(known)}")
    return known[name]


def stored(run: Run, point: Mapping[str, Any], kind: str) -> Shown:
    """A stored episode of a point.

    Args:
        run: The measurement.
        point: One of its points.
        kind: worst or median.

    Raises:
        UserError: Its episodes were not kept, or cannot be drawn.
    """
    arrays = stored_episodes(run.frontier, point)
    if arrays["snapshots"].shape[-1] == 0:
        raise UserError(f"{point['id']} has no film: its task keeps no snapshots of an episode")
    mine = episode(run.task, arrays, kind)
    beside = episode(run.task, arrays, kind, canonical=True)
    ending = _ending(mine["return"], mine["outcome"])
    return Shown(
        f"{title_of(point)}\n{kind} episode: {ending}",
        read_motion(run.scene, mine),
        read_motion(run.scene, beside),
    )


def title_of(point: Mapping[str, Any]) -> str:
    """A point in a line.

    Example:
        >>> found = {"lambda": "inf", "naturalness": 0.912, "adversarialness": 0.5}
        >>> title_of({"id": "s0-r1-l6", **found})
        's0-r1-l6 · λ ∞ · naturalness 0.91 · adversarialness 0.50'
    """
    weight = "∞" if point["lambda"] == "inf" else f"{point['lambda']:.3g}"
    y = point["adversarialness"]
    harm = "unknown" if y is None else f"{y:.2f}"
    numbers = f"naturalness {point['naturalness']:.2f} · adversarialness {harm}"
    return f"{point['id']} · λ {weight} · {numbers}"


def played(task: Task, robot: str, human: str, seed: int, opening: Opening = SAFE) -> Shown:
    """A new episode of any pair: that of `rigid evaluate --episodes 1` with the same seed.

    Args:
        task: The task.
        robot: As `--robot` names it; acts by its mean.
        human: As `--human` names it; samples.
        seed: Start and noise come from it.
        opening: How their files are opened.

    Raises:
        UserError: A policy does not fit, or the task's episodes cannot be drawn.
    """
    from rigid.compute.playing import play_with
    from rigid.learning.rollout import policy_actor
    from rigid.policies.loading import load_policy

    rng = np.random.default_rng([seed, 0])
    starts = rng.integers(2**31, size=1)
    acting = load_policy(robot, task=task, agent="robot", opening=opening)
    partner = load_policy(human, task=task, agent="human", opening=opening)
    actor = policy_actor(partner, 1, rng)
    snapshots: list[np.ndarray] = []
    episodes = play_with(task, acting, actor, starts, snapshots=snapshots)
    motion = read_motion(scene_of(task), task.replay(np.stack(snapshots)[:, 0]))
    outcome = task.outcome_names[int(episodes.summary.outcome[0])]
    ending = _ending(float(episodes.returns[0]), outcome)
    return Shown(f"{_short(robot)} with {_short(human)}\nseed {seed}: {ending}", motion, None)


def _ending(total: float, outcome: str) -> str:
    return f"return {total:.1f}, {outcome.replace('_', ' ')}"


def _short(policy: str) -> str:
    """The last part of a policy's name or path."""
    return policy.rstrip("/").rpartition("/")[2]

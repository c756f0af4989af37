"""Failures grouped by kind, so that a reader sees the modes, not one failure after the other.

`failures.json` beside `report.html` holds them for programs.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically, writing_to
from rigid.frontier.result import Frontier, load_frontier
from rigid.report.episodes import goal_of
from rigid.report.failure_kinds import words
from rigid.report.payload import Failure, FailureMode, FailureModes

_Which = Literal["worst", "median"]
_EPISODES: Final[tuple[_Which, ...]] = ("worst", "median")
_HELPED = "helped"
_CURE = "delete it and run `rigid report` again"


class _Shown(NamedTuple):
    """An episode that failed in a way that is known."""

    point: Mapping[str, Any]
    episode: _Which
    failure: Failure
    share: float
    """Of the human's episodes, those it stands for."""


def group(
    points: Sequence[Mapping[str, Any]], replays: Mapping[str, Any] | None, goal: str
) -> FailureModes | None:
    """The modes in which a robot fails, those of the most natural humans first.

    Args:
        points: As in `frontier.json`.
        replays: `rigid.report.payload.Payload`'s, each episode with its `failure`.
        goal: What the tool is to reach, in a word.

    Returns:
        None where episodes failed, but nothing is known of any of them.
    """
    if replays is None:
        return None
    judged = [point for point in points if None not in point["outcomes"].values()]
    shown = [seen for point in judged for seen in _shown(point, replays[point["id"]])]
    if not shown and any(_silent(replays[point["id"]]) for point in judged):
        return None
    failed = sum(_failed(point) for point in judged)
    humans = max(len(judged), 1)
    by_mode: dict[tuple[str, str | None], list[_Shown]] = {}
    for seen in shown:
        by_mode.setdefault((seen.failure["kind"], seen.failure["part"]), []).append(seen)
    modes = [_mode(members, humans, goal) for members in by_mode.values()]
    modes.sort(key=lambda mode: (-mode["naturalness"][1], -mode["share"], mode["title"]))
    unseen = failed - sum(seen.share for seen in shown)
    return {"humans": len(judged), "modes": modes, "unseen": max(unseen, 0.0) / humans}


def failure_modes(directory: Path | str) -> FailureModes | None:
    """The modes in which the robot of a finished run fails; None where the task does not tell.

    Reads `failures.json`, which `rigid report` wrote; without it, episodes are simulated again: a
    fifth of a second for each.

    Raises:
        UserError: The run is not finished, or a file of it is damaged.
    """
    from rigid.report.gather import replays, task_of  # It groups failures too.

    frontier = load_frontier(directory)
    run = RunDirectory(frontier.directory)
    if run.failures.exists():
        return _stored(run.failures)
    task = task_of(read_settings(run))
    if task is None:
        return None
    return group(frontier.points, replays(frontier, task), goal_of(task.scene()))


def write_failures(frontier: Frontier, modes: FailureModes | None) -> None:
    """Writes `failures.json` into the run, where there is something to tell."""
    if modes is None:
        return
    names = {name: frontier.data[name] for name in ("task", "robot", "preset")}
    text = json_text({"schema": 1, **names, **modes}, indent=1)
    path = RunDirectory(frontier.directory).failures
    with writing_to(path):
        write_atomically(path, text.encode())


def _stored(path: Path) -> FailureModes:
    try:
        data = json.loads(read_bytes(path, cure=_CURE))
        return {"humans": data["humans"], "modes": data["modes"], "unseen": data["unseen"]}
    except (ValueError, KeyError, TypeError):
        raise UserError(f"{path} is damaged: {_CURE}") from None


def _silent(replays: Mapping[str, Any]) -> bool:
    """Whether one of a human's episodes failed, but does not tell how."""
    return any(
        episode["outcome"] != _HELPED and episode.get("failure") is None
        for episode in replays.values()
    )


def _failed(point: Mapping[str, Any]) -> float:
    """Share of a human's episodes that were not helped."""
    return float(sum(share for name, share in point["outcomes"].items() if name != _HELPED))


def _shown(point: Mapping[str, Any], replays: Mapping[str, Any]) -> Iterator[_Shown]:
    """A human's failures; those that ended alike share the weight of that outcome."""
    known = {
        name: replays[name]
        for name in _EPISODES
        if name in replays and replays[name].get("failure") is not None
    }
    alike = Counter(episode["outcome"] for episode in known.values())
    for name, episode in known.items():
        outcome = episode["outcome"]
        share = point["outcomes"].get(outcome, 0.0) / alike[outcome]
        yield _Shown(point, name, episode["failure"], share)


def _mode(members: Sequence[_Shown], humans: int, goal: str) -> FailureMode:
    """One mode from its episodes: of a human who shows it twice, the worst comes first."""
    natural = sorted(members, key=lambda seen: -seen.point["naturalness"])
    first = natural[0]
    kind, part = first.failure["kind"], first.failure["part"]
    title, meaning = words(kind, goal)
    return {
        "kind": kind,
        "part": part,
        "title": title if part is None else f"{title}: {part}",
        "meaning": meaning,
        "points": list(dict.fromkeys(seen.point["id"] for seen in natural)),
        "naturalness": [natural[-1].point["naturalness"], first.point["naturalness"]],
        "share": sum(seen.share for seen in members) / humans,
        "example": {
            "id": first.point["id"],
            "episode": first.episode,
            "naturalness": first.point["naturalness"],
            "frame": first.failure["frame"],
            "time": first.failure["time"],
            "says": first.failure["says"],
        },
    }

"""Recorded episodes for pairs: whom each human met, how natural it is, and what it looked like."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rigid.compute.pairs.members import Candidate, MeasuredRun
from rigid.compute.people.recorded import (
    judge_recording,
    replay_recording,
    reproduced,
    stored_panels,
)
from rigid.compute.subject import measured_robot
from rigid.data.episodes import CanonicalEpisodes, load_episodes
from rigid.data.pair_file import RecordedMember, file_hash
from rigid.errors import UserError
from rigid.naturalness.features import DEFAULT
from rigid.naturalness.panel import Panel
from rigid.naturalness.strictest import UpperBound
from rigid.policies.opening import NAMED_BY_FILE, SAFE
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task, adversarialness

Say = Callable[[str], None]


class Recording(NamedTuple):
    """A file of episodes of one human."""

    path: Path
    key: str
    """SHA-256 of the file."""
    episodes: CanonicalEpisodes


class _Court(NamedTuple):
    """Runs that hold humans against one canonical law, and every referee that they stored.

    Each referee bounds the overlap with that law, whichever run it belongs to, so that more runs of
    a robot give a tighter bound.
    """

    runs: tuple[int, ...]
    robot: Policy
    features: str
    referees: tuple[tuple[int, str], ...]
    """Run and point of each."""
    panels: tuple[Panel, ...]


def read_recordings(paths: Sequence[Path], task: Task) -> list[Recording]:
    """Recorded episodes of a task, in the order of their hashes.

    Raises:
        UserError: A file is damaged, of another task or without returns, or two hold the same.
    """
    loaded = [(path, load_episodes(path, task=task)) for path in paths]
    found = [Recording(path, file_hash(path), episodes) for path, episodes in loaded]
    found.sort(key=lambda recording: recording.key)
    for before, after in pairwise(found):
        if before.key == after.key:
            raise UserError(f"{before.path} and {after.path} hold the same: name one of them")
    for path, _, episodes in found:
        if np.isnan(episodes.returns).all():
            raise UserError(
                f"{path} holds no returns, so nobody knows how adversarial its episodes are: "
                "record returns as well, as `rigid record` does"
            )
    return found


def recorded_episodes(
    runs: Sequence[MeasuredRun],
    recordings: Sequence[Recording],
    *,
    robot: str | None = None,
    say: Say = lambda _: None,
) -> list[list[Candidate]]:
    """The recorded episodes of known return, for each run of the robot that the human met.

    Args:
        runs: Of one task.
        recordings: Of the same.
        robot: Where the measured robot is now; by default where it was.
        say: Told of progress.

    Raises:
        UserError: No run measured the robot of a recording, or a recording cannot be judged.
    """
    found: list[list[Candidate]] = [[] for _ in runs]
    courts = _courts(runs, robot) if recordings else []
    for number, recording in enumerate(recordings):
        path, _, episodes = recording
        say(f"{path}: playing {len(episodes)} recorded episodes again")
        met = False
        for court in courts:
            run = runs[court.runs[0]]
            replayed = replay_recording(run.task, court.robot, episodes, where=path)
            if not reproduced(episodes, replayed, run.return_range):
                continue
            met = True
            bound = judge_recording(court.panels, court.features, run.task, episodes, where=path)
            members = _members(episodes, number, bound, court, run.return_range)
            for place in court.runs:
                found[place] += [Candidate(m, replayed.states[m.episode]) for m in members]
        if not met:
            raise UserError(
                f"{path} was recorded with another robot than these runs measured: played again "
                "with theirs, its episodes do not return the same; name a run of the robot that "
                "it was recorded with"
            )
    return found


def _courts(runs: Sequence[MeasuredRun], robot: str | None) -> list[_Court]:
    """The runs by what they hold humans against."""
    together: dict[str, list[int]] = {}
    for place, run in enumerate(runs):
        together.setdefault(_law(run), []).append(place)
    courts = []
    for places in together.values():
        first = runs[places[0]]
        spec, opening = robot or str(first.frontier.data["robot"]), SAFE if robot else NAMED_BY_FILE
        ids = {place: [point["id"] for point in runs[place].frontier.points] for place in places}
        panels = [p for place in places for p in stored_panels(runs[place].directory, ids[place])]
        courts.append(_Court(
            tuple(places), measured_robot(spec, first.task, first.identity, opening=opening),
            str(first.identity.get("features", DEFAULT)),
            tuple((place, point) for place in places for point in ids[place]), tuple(panels),
        ))  # fmt: skip
    return courts


def _law(run: MeasuredRun) -> str:
    """What names the canonical law of a run: robot, human, features, range; people by their data.

    A synthetic human has the same law in every recording.
    """
    identity, source = run.identity, run.frontier.data["canonical"]["source"]
    data = identity.get("canonical") if source == "recorded" else None
    parts = (identity["robot"], identity.get("human"), identity.get("features", DEFAULT), data)
    return json.dumps([*parts, *run.return_range])


def _members(
    episodes: CanonicalEpisodes,
    number: int,
    bound: UpperBound,
    court: _Court,
    return_range: tuple[float, float],
) -> list[RecordedMember]:
    """The episodes of known return as a pair names them."""
    harm = adversarialness(episodes.returns, return_range)
    run, point = court.referees[bound.referee]
    return [
        RecordedMember(
            recording=number, referee_run=run, referee=point, episode=int(episode),
            seed=int(episodes.seeds[episode]), naturalness=bound.naturalness,
            naturalness_se=bound.se, adversarialness=float(harm[episode]),
            snapshot=0, snapshot_by="deviation",
        )
        for episode in np.flatnonzero(~np.isnan(episodes.returns))
    ]  # fmt: skip

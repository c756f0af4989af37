"""All episodes that a set of runs and recordings offers for pairs, in an order of their own.

Runs and recordings are sorted by the hashes of their files, so that nothing depends on the order in
which they were named, or on where they lie.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Int

from rigid.compute.pairs.members import (
    Candidate,
    Companion,
    MeasuredRun,
    found_episodes,
    read_run,
    starts_of,
)
from rigid.compute.pairs.recordings import Recording, Say, recorded_episodes
from rigid.data.pair_file import FoundMember
from rigid.errors import UserError
from rigid.files import first_difference
from rigid.frontier.pairs import Candidates, reference_of


class Companions(NamedTuple):
    """The canonical episodes that one run keeps, from which references are taken."""

    each: list[Companion]
    starts: Int[np.ndarray, " n"]

    def reference(self, *, start: int, shown: Sequence[int]) -> int:
        """Which of them a pair is held against; see `reference_of`."""
        returns = np.array([companion.total for companion in self.each])
        seeds = np.array([companion.reference.seed for companion in self.each])
        return reference_of(returns, self.starts, seeds, start=start, shown=shown)


class Pool(NamedTuple):
    """What pairs are picked from."""

    candidates: list[Candidate]
    columns: Candidates
    """The same as arrays, row by row."""
    companions: list[Companions]
    """Of each run."""


def read_runs(directories: Sequence[Path]) -> list[MeasuredRun]:
    """Finished runs of one task.

    Raises:
        UserError: One is no such run, they are of different tasks, or two are the same.
    """
    runs = sorted(map(read_run, directories), key=lambda run: run.key)
    for before, after in pairwise(runs):
        if before.key == after.key:
            raise UserError(
                f"{before.directory} and {after.directory} are the same run: name it once"
            )
    for run in runs:
        different = first_difference(runs[0].identity["task"], run.identity["task"])
        if different is not None:
            name, here, there = different
            raise UserError(
                f"{runs[0].directory} was measured with {name} = {here!r}, {run.directory} with "
                f"{there!r}: pick pairs from runs of one task at a time"
            )
    return runs


def fill_pool(
    runs: Sequence[MeasuredRun],
    recordings: Sequence[Recording],
    *,
    robot: str | None = None,
    say: Say = lambda _: None,
) -> Pool:
    """Everything that the runs keep, and each recording with the runs of the robot it met.

    Args:
        runs: Of one task.
        recordings: Of the same.
        robot: Where the measured robot is now; by default where it was.
        say: Told of progress.

    Raises:
        UserError: A file of a run is damaged, or no run measured the robot of a recording.
    """
    kept = [found_episodes(run) for run in runs]
    for run, (mine, _) in zip(runs, kept, strict=True):
        say(f"{run.directory}: {len(mine)} episodes of adversaries")
    people = recorded_episodes(runs, recordings, robot=robot, say=say)
    by_run = [[*mine, *met] for (mine, _), met in zip(kept, people, strict=True)]
    starts: list[np.ndarray] = []
    companions: list[Companions] = []
    for run, mine, (_, beside) in zip(runs, by_run, kept, strict=True):
        seeds = [c.member.seed for c in mine] + [c.reference.seed for c in beside]
        begun = starts_of(run.task, seeds)
        starts.append(begun[: len(mine)])
        companions.append(Companions(beside, begun[len(mine) :]))
    everyone = [candidate for mine in by_run for candidate in mine]
    return Pool(everyone, _columns(by_run, np.concatenate(starts)), companions)


def _columns(by_run: Sequence[Sequence[Candidate]], starts: Int[np.ndarray, " n"]) -> Candidates:
    """The candidates as arrays."""
    members = [candidate.member for mine in by_run for candidate in mine]
    runs = [run for run, mine in enumerate(by_run) for _ in mine]
    humans = [
        (run, member.point) if isinstance(member, FoundMember) else (-1, member.recording)
        for run, member in zip(runs, members, strict=True)
    ]
    episodes = [(*human, member.episode) for human, member in zip(humans, members, strict=True)]
    return Candidates(
        naturalness=np.array([member.naturalness for member in members], dtype=float),
        adversarialness=np.array([member.adversarialness for member in members], dtype=float),
        run=np.array(runs, dtype=int),
        human=_numbered(humans),
        start=starts,
        recorded=np.array([member.origin == "recording" for member in members], dtype=bool),
        episode=_numbered(episodes),
    )


def _numbered(keys: Sequence[Hashable]) -> Int[np.ndarray, " n"]:
    """A number for each key, equal ones for equal keys."""
    known: dict[Hashable, int] = {}
    return np.array([known.setdefault(key, len(known)) for key in keys], dtype=int)

"""The episodes that a pair file names, as motions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.compute.people.recorded import replay_recording
from rigid.compute.run.checkpoint import load_arrays
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.compute.subject import measured_robot
from rigid.data.episodes import load_episodes
from rigid.data.pair_file import (
    SHOWN,
    FoundMember,
    Pair,
    RecordedMember,
    Reference,
    check_sources,
    source_path,
)
from rigid.errors import UserError
from rigid.files import first_difference
from rigid.policies.protocol import Policy
from rigid.study.judging.clip_names import ClipName
from rigid.study.judging.questionnaire import Questionnaire
from rigid.tasks.protocol import Task

_CURE = "put it back, or pick the pairs again with `rigid pairs`"
_States = Float[np.ndarray, "T1 state"]


class PairMotions:
    """Reads runs and recordings of a questionnaire, each once."""

    def __init__(
        self, asks: Questionnaire, task: Task, find_robot: Callable[[str], Policy | None]
    ) -> None:
        """Opens the questionnaire.

        Args:
            asks: Whose pairs.
            task: The study's.
            find_robot: One of the study's robots by its hash; else the run's own name is tried.

        Raises:
            UserError: The pairs are of another task.
        """
        self._asks, self._task, self._find_robot = asks, task, find_robot
        different = first_difference(asks.file.task, task.describe())
        if different is not None:
            name, theirs, mine = different
            raise UserError(
                f"{asks.path} holds pairs of a task with {name} = {theirs!r}, but the study's task "
                f"has {mine!r}: pick pairs from runs of the study's task"
            )
        self.replay = cache(self._replay)
        """The whole episode that a clip shows, by pair and who."""
        self._arrays = cache(self._read_arrays)
        self._recorded = cache(self._play_recording)

    def shows(self, name: ClipName) -> dict[str, Any]:
        """What a clip shows, independent of where its files lie: equal ones are the same motion."""
        pair, file = self._asks.file.pairs[name.pair], self._asks.file
        shown = _episode(pair, name)
        about = {"task": dict(self._task.describe()), "moment": name.moment}
        run = file.runs[pair.run]
        if isinstance(shown, RecordedMember):
            recording = file.recordings[shown.recording]
            return {
                **about, "recording": recording.sha256, "robot": run.robot_sha256,
                "episode": shown.episode,
            }  # fmt: skip
        return {
            **about, "episodes": run.episodes_sha256[shown.point], "shown": shown.shown,
            "canonical": isinstance(shown, Reference),
        }  # fmt: skip

    def check(self) -> None:
        """Makes sure that runs and recordings are those that were picked from.

        Raises:
            UserError: One is missing or has changed.
        """
        check_sources(self._asks.path, self._asks.file)

    def _replay(self, name: ClipName) -> Mapping[str, Any]:
        pair = self._asks.file.pairs[name.pair]
        shown = _episode(pair, name)
        if isinstance(shown, RecordedMember):
            states = self._recorded(pair.run, shown.recording)[shown.episode]
        else:
            kind = "canonical_snapshots" if isinstance(shown, Reference) else "snapshots"
            states = self._arrays(pair.run, shown.point)[kind][SHOWN.index(shown.shown)]
        if name.moment is not None and name.moment >= len(states):
            raise UserError(
                f"{self._asks.path}: pair {name.pair} shows step {name.moment} of an episode of "
                f"{len(states) - 1} steps: pick the pairs again with `rigid pairs`"
            )
        return self._task.replay(states)

    def _run(self, number: int) -> Path:
        return source_path(self._asks.path, self._asks.file.runs[number])

    def _read_arrays(self, run: int, point: str) -> dict[str, np.ndarray]:
        return load_arrays(
            RunDirectory(self._run(run)).adversary(point) / "episodes.npz", cure=_CURE
        )

    def _play_recording(self, run: int, recording: int) -> Float[np.ndarray, "E T1 state"]:
        path = source_path(self._asks.path, self._asks.file.recordings[recording])
        episodes = load_episodes(path, task=self._task)
        source = self._asks.file.runs[run]
        robot = self._find_robot(source.robot_sha256) or measured_robot(
            source.robot, self._task, read_settings(RunDirectory(self._run(run)))["identity"],
            cure="name it among the study's robots",
        )  # fmt: skip
        return replay_recording(self._task, robot, episodes, where=path).states


def _episode(pair: Pair, name: ClipName) -> FoundMember | RecordedMember | Reference:
    if name.who == "reference":
        return pair.reference
    return pair.first if name.who == "first" else pair.second

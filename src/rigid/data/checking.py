"""Episodes on disk, judged as recordings are."""

from __future__ import annotations

import numpy as np

from rigid.data.episodes import CanonicalEpisodes
from rigid.data.importing import feature_limits
from rigid.data.judging import Verdict, judge_steps
from rigid.data.resampling import Steps
from rigid.tasks.protocol import Task


def judge_file(episodes: CanonicalEpisodes, task: Task) -> list[Verdict]:
    """A verdict on each episode: frozen, out of range, the same as another.

    Args:
        episodes: As `load_episodes` gives them for this task.
        task: Names the features and gives their limits.
    """
    steps, notes = episodes.features.shape[1], episodes.about.episodes
    verdicts = [
        Verdict(
            episode=(notes[i].name if notes else "") or str(i),
            participant=notes[i].participant if notes else "",
            rows=steps, seconds=round(steps * episodes.control_period, 3),
        )
        for i in range(len(episodes))
    ]  # fmt: skip
    times = episodes.control_period * np.arange(1, steps + 1)
    made = [
        Steps(times, episodes.features[i], None,
              None if episodes.actions is None else episodes.actions[i], None)
        for i in range(len(episodes))
    ]  # fmt: skip
    return judge_steps(verdicts, made, task, feature_limits(task))

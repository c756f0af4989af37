"""What a recording lacks and its robot knows: observations, rewards, returns and success.

Where seeds and the human's actions were recorded, an episode comes out again against the robot that
it was recorded with, and shows everything. Where it does not come out again, nothing is filled in.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from rigid.compute.people.recorded import RETURN_TOLERANCE, play_again
from rigid.data.episodes import CanonicalEpisodes
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task

APART = 0.1
"""Largest root mean square difference between features and those of the replay, in deviations of
each feature over the file, of an episode that counts as the same; of observations too. Ours."""


class Completed(NamedTuple):
    """Episodes with what their replay showed."""

    episodes: CanonicalEpisodes
    same: Bool[np.ndarray, " E"]
    """Those that came out again."""


def _alike(
    played: Float[np.ndarray, "T E n"], told: Float[np.ndarray, "E T n"]
) -> Bool[np.ndarray, " E"]:
    scale = np.maximum(told.std(axis=(0, 1)), 1e-6)
    apart = (played.swapaxes(0, 1) - told) / scale
    return np.asarray(np.sqrt((apart**2).mean(axis=(1, 2))) <= APART)


def _returned(
    task: Task, told: Float[np.ndarray, " E"], played: Float[np.ndarray, " E"]
) -> Bool[np.ndarray, " E"]:
    """Where a return was told, whether the replay has it."""
    known = np.isfinite(told)
    if task.return_range is not None:
        allowed = RETURN_TOLERANCE * (task.return_range[1] - task.return_range[0])
    else:
        allowed = APART * float(told[known].std()) if known.any() else 0.0
    return np.asarray(~known | (np.abs(told - played) <= allowed))


def complete(task: Task, robot: Policy, episodes: CanonicalEpisodes, *, where: Path) -> Completed:
    """Plays episodes again and fills in what they lack; what was recorded stays as it is.

    Args:
        task: Theirs.
        robot: That the human met; acts by its mean.
        episodes: With actions, and the seeds that they started from.
        where: Their source, for messages.

    Raises:
        UserError: Nobody recorded actions, or the seeds.
    """
    played = play_again(task, robot, episodes, where=where)
    same = _alike(played.features, episodes.features) & (played.faulted == 0)
    if episodes.observations is not None:  # They show the robot, which features do not.
        same &= _alike(played.human_observation, episodes.observations)
    same &= _returned(task, episodes.returns, played.returns)
    rewards, observations = episodes.rewards, episodes.observations
    if same.all():  # A part of an array cannot be unknown.
        rewards = played.reward.swapaxes(0, 1) if rewards is None else rewards
        if observations is None:
            observations = played.human_observation.swapaxes(0, 1)

    def filled(told: np.ndarray, shown: np.ndarray) -> np.ndarray:
        return np.where(np.isnan(told) & same, shown, told).astype(np.float32)

    found = replace(
        episodes, rewards=rewards, observations=observations,
        returns=filled(episodes.returns, played.returns),
        success=filled(episodes.success, played.summary.success),
    )  # fmt: skip
    return Completed(found, same)

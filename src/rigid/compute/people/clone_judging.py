"""Whether a clone moves like people: it plays with the robot, and referees tell it from them."""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import numpy as np

from rigid.compute.canonical import FEWEST, MOST_FOR_FOLDS
from rigid.compute.playing import play_with
from rigid.compute.search.scoring import naturalness_of
from rigid.data.episodes import CanonicalEpisodes
from rigid.learning.rollout import Trajectories, policy_actor
from rigid.naturalness.features import DEFAULT, choose_features
from rigid.naturalness.panel import Fold, split_in_folds, train_panel
from rigid.naturalness.referee import RefereeSettings
from rigid.naturalness.views import Episodes
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task

_SHARES = (0.4, 0.15, 0.45)
"""Of the played episodes: training and validation of the referee, and what it judges. Ours."""


class Played(NamedTuple):
    """Episodes of the clone with the robot."""

    episodes: Trajectories
    features: np.ndarray
    """[E, T, f], as the task's referees see them."""


def play_clone(task: Task, robot: Policy, human: Policy, rollouts: int, seed: int) -> Played:
    """The clone with the robot, `rollouts` times, each from a start of its own."""
    rng = np.random.default_rng([seed, 2])
    starts = rng.integers(2**31, size=rollouts)
    episodes = play_with(task, robot, policy_actor(human, rollouts, rng), starts)
    chosen = choose_features(DEFAULT, task)
    features = chosen.of(episodes.features, episodes.human_observation, episodes.human_action)
    return Played(episodes, features.swapaxes(0, 1))


def held_out_naturalness(
    task: Task, held_out: CanonicalEpisodes, played: Played, seed: int
) -> dict[str, Any] | None:
    """The same against people of whom the clone saw nothing; None where they are too few.

    Fewer episodes make milder referees, so that this is no lower by itself.
    """
    if len(held_out) < FEWEST:
        return None
    found = clone_naturalness(task, held_out, played, seed)
    return {name: found[name] for name in ("naturalness", "naturalness_se")} | {
        "episodes": len(held_out)
    }


def clone_naturalness(
    task: Task, recorded: CanonicalEpisodes, played: Played, seed: int
) -> dict[str, Any]:
    """Of the clone, by referees of its own that are cross-fitted on every recorded episode.

    On all of them and not on the held-out ones alone: a referee with less data errs towards
    natural. The clone saw what people did in the others, never how they moved from step to step.
    """
    assert recorded.observations is not None
    assert recorded.actions is not None
    chosen = choose_features(DEFAULT, task)
    features = chosen.of(recorded.features, recorded.observations, recorded.actions)
    features = features[np.random.default_rng([seed, 3]).permutation(len(features))]
    settings = RefereeSettings()
    if len(features) > MOST_FOR_FOLDS:
        folds: tuple[Fold, ...] = (Fold(*np.array_split(features, 3)),)
    else:
        folds = split_in_folds(features, settings.folds)
    sound = played.episodes.weight.swapaxes(0, 1) > 0
    ends = np.cumsum(np.round(np.array(_SHARES) * len(sound)).astype(int))
    everyone = Episodes(played.features, sound)
    train, validation, judged = (
        everyone.part(slice(low, high))
        for low, high in ((0, ends[0]), (ends[0], ends[1]), (ends[1], None))
    )
    panel = train_panel(folds, train, validation, settings, jax.random.key(seed))
    return naturalness_of(panel, judged)

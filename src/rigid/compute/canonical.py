"""Canonical episodes by use: those that the search may see, and the folds of the referee's.

A synthetic human is played again for the referee. People are not: their episodes are divided.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from rigid.data.episodes import CanonicalEpisodes
from rigid.errors import UserError
from rigid.naturalness.features import DEFAULT, Features
from rigid.naturalness.panel import Fold, split_in_folds

FEWEST, MOST_FOR_FOLDS = 12, 400
"""Recorded episodes between which referees are cross-fitted (`docs/referee.md`). Ours."""
_SEARCH_SHARE = 3
"""The search sees one in so many recorded episodes, and no more than the preset's number. Ours."""
_SHUFFLE_SEED = 0  # People come one after the other in a file; every part should see all of them.


class Divided(NamedTuple):
    """Canonical episodes by use."""

    search: CanonicalEpisodes
    referee: CanonicalEpisodes
    """Every episode that referees see."""
    folds: tuple[Fold, ...]
    anchor: slice
    """Those of them that the canonical point is measured on."""
    whole: CanonicalEpisodes
    """By which a measurement is known: a file of people, or what the search sees."""


def divide_synthetic(search: CanonicalEpisodes, referee: CanonicalEpisodes) -> Divided:
    """One fold of three equal parts; the anchor is the part that tests."""
    third = len(referee) // 3
    folds = (Fold(*np.split(referee.features, 3)),)
    return Divided(search, referee, folds, slice(2 * third, None), search)


def divide_recorded(
    episodes: CanonicalEpisodes, *, search: int, folds: int, where: Path
) -> Divided:
    """Divides episodes of people between the search and K folds of the referee's, whole episodes.

    Args:
        episodes: Recorded from people.
        search: Most episodes that the search may see.
        folds: K; above 400 episodes there is one fold of three equal parts.
        where: The file, for messages.

    Raises:
        UserError: There are fewer than 12.
    """
    count = len(episodes)
    if count < FEWEST:
        raise UserError(
            f"{where} holds {count} recorded episodes, but the referee needs at least {FEWEST}: "
            "record more, since fewer cannot tell natural from unnatural"
        )
    order = np.random.default_rng(_SHUFFLE_SEED).permutation(count)
    shown = _shown(count, search)
    referee = pick(episodes, order[shown:])
    if count > MOST_FOR_FOLDS:
        crossed: tuple[Fold, ...] = (Fold(*np.array_split(referee.features, 3)),)
    else:
        crossed = split_in_folds(referee.features, folds)
    return Divided(pick(episodes, order[:shown]), referee, crossed, slice(None), episodes)


def _shown(count: int, search: int) -> int:
    return min(search, count // _SEARCH_SHARE)


def trained_on(count: int, *, search: int, folds: int) -> int:
    """How many of `count` recorded episodes train each referee, on average and rounded down.

    Example:
        >>> trained_on(40, search=40, folds=4)
        13
    """
    left = count - _shown(count, search)
    return -(-left // 3) if count > MOST_FOR_FOLDS else left * (folds - 2) // folds


def pick(episodes: CanonicalEpisodes, which: np.ndarray) -> CanonicalEpisodes:
    """Some of the episodes, in the order of `which`."""
    return replace(
        episodes,
        features=episodes.features[which],
        observations=None if episodes.observations is None else episodes.observations[which],
        actions=None if episodes.actions is None else episodes.actions[which],
        seeds=episodes.seeds[which],
        returns=episodes.returns[which],
        success=episodes.success[which],
        rewards=None if episodes.rewards is None else episodes.rewards[which],
        times=None if episodes.times is None else episodes.times[which],
        about=episodes.about.pick(which),
    )


def chosen_features(
    features: Features, episodes: CanonicalEpisodes, where: Path | None
) -> Float[np.ndarray, "E T f"]:
    """What naturalness sees of recorded episodes.

    Args:
        features: The choice of a measurement.
        episodes: Of its task.
        where: Their file, for messages.

    Raises:
        UserError: The choice takes the human's observations and actions, which they lack.
    """
    if features.label == DEFAULT:
        return episodes.features
    if max(features.columns) < episodes.features.shape[2]:  # Some of the task's own.
        return episodes.features[..., list(features.columns)]
    if episodes.observations is None or episodes.actions is None:
        raise UserError(
            f"{where} holds no observations and actions, so features {features.label!r} cannot be "
            "taken from it: leave --features out, or record it again with `rigid record`"
        )
    return features.of(episodes.features, episodes.observations, episodes.actions)

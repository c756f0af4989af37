"""Canonical episodes by use: whole episodes, none twice."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigid.compute.canonical import chosen_features, divide_recorded, trained_on
from rigid.data.about import About, EpisodeNote
from rigid.data.episodes import CanonicalEpisodes
from rigid.errors import UserError
from rigid.naturalness.features import Features

FILE = Path("people.npz")


def recorded(count):
    """Episode i holds i everywhere."""
    numbers = np.arange(count, dtype=np.float32)
    return CanonicalEpisodes(
        features=np.tile(numbers[:, None, None], (1, 5, 2)), observations=None, actions=None,
        seeds=np.arange(count), returns=numbers, success=numbers, task={"name": "toy"},
        feature_names=("a", "b"), source="recorded", provenance={},
    )  # fmt: skip


def divided(count):
    return divide_recorded(recorded(count), search=40, folds=4, where=FILE)


@pytest.mark.parametrize(
    ("count", "search", "folds"), [(12, 4, 4), (60, 20, 4), (400, 40, 4), (401, 40, 1)]
)
def test_people_are_divided_between_search_and_folds(count, search, folds):
    found = divided(count)
    assert (len(found.search), len(found.folds)) == (search, folds)
    for fold in found.folds:
        parts = [part[:, 0, 0] for part in (fold.train, fold.validation, fold.test)]
        assert all(len(part) for part in parts)
        everyone = np.concatenate([found.search.returns, *parts])
        assert sorted(everyone) == list(range(count))


@pytest.mark.parametrize("count", [12, 31, 60, 400, 401])
def test_the_number_that_trains_each_referee_is_that_of_the_folds(count):
    trained = [len(fold.train) for fold in divided(count).folds]
    assert trained_on(count, search=40, folds=4) == int(np.mean(trained))


def test_features_stay_with_their_episode():
    found = divided(24).referee
    np.testing.assert_array_equal(found.features[:, 0, 0], found.returns)
    np.testing.assert_array_equal(found.seeds, found.returns)


def test_eleven_episodes_are_too_few():
    with pytest.raises(UserError, match=r"people\.npz holds 11 recorded episodes, .* at least 12"):
        divided(11)


def test_what_is_told_of_an_episode_stays_with_it():
    notes = tuple(EpisodeNote(name=str(i)) for i in range(24))
    people = replace(recorded(24), about=About(licence="CC0-1.0", episodes=notes))
    found = divide_recorded(people, search=40, folds=4, where=FILE).referee
    assert [float(note.name) for note in found.about.episodes] == found.returns.tolist()
    assert found.about.licence == "CC0-1.0"


def test_features_by_name_need_no_observations():
    people = recorded(12)
    chosen = Features("b", ("b",), (1,))
    assert chosen_features(chosen, people, FILE).shape == (12, 5, 1)
    with pytest.raises(UserError, match="holds no observations and actions, so features"):
        chosen_features(Features("observation", ("x",), (2,)), people, FILE)

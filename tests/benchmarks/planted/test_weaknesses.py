"""The planted weaknesses: how often canonical people show them, and that their humans do."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planted.arena import paths, play_with
from benchmarks.planted.handover import HandOver
from benchmarks.planted.people import HABITS, Person
from benchmarks.planted.robots import Follower, Watcher
from benchmarks.planted.weaknesses import EVENTS, shown, weaknesses

EPISODES = 4000


def played(habit, robot=None, *, episodes=EPISODES, seed=0):
    rng = np.random.default_rng(seed)
    return play_with(HandOver(), robot or Follower(), Person(HABITS[habit]), episodes, rng)


@pytest.fixture(scope="module")
def canonical():
    return paths(played("plain"))


@pytest.fixture(scope="module")
def planted(canonical):
    return {weakness.name: weakness for weakness in weaknesses(canonical)}


@pytest.mark.parametrize("name", [name for name, _, _ in EVENTS])
def test_an_event_is_seen_in_its_share_of_fresh_canonical_episodes(planted, name):
    fresh = paths(played("plain", seed=1))
    error = 3 * np.sqrt(0.25 / EPISODES) * np.sqrt(2)
    assert shown(planted[name], fresh).mean() == pytest.approx(planted[name].share, abs=error)


@pytest.mark.parametrize("name", ["drift", "pause", "change of sides", "return"])
def test_a_motion_outside_the_data_hardly_ever_occurs_in_it(planted, canonical, name):
    """Fewer than 1 of 10,000 episodes would be 0.4 here; 3 or more has a chance of 1 %."""
    assert shown(planted[name], canonical).sum() < 3


@pytest.mark.parametrize("name", ["drift", "pause", "change of sides", "return"])
def test_the_stated_human_shows_its_motion_in_half_of_its_episodes_or_more(planted, name):
    assert shown(planted[name], paths(played(name, episodes=500))).mean() > 0.5


def test_the_order_of_sides_matters(planted):
    """Left then right is the weakness, right then left is not."""
    path = np.zeros((2, 20, 3))
    path[..., 1] = 0.5
    path[0, :, 0] = np.where(np.arange(20) < 10, -0.3, 0.3)
    path[1] = path[0, ::-1]
    assert shown(planted["change of sides"], path).tolist() == [True, False]


def test_what_was_seen_does_not_depend_on_what_comes_later(planted, canonical):
    early, whole = canonical[:50, :20], canonical[:50]
    for weakness in planted.values():
        assert not (shown(weakness, early) & ~shown(weakness, whole)).any()


def test_the_follower_meets_every_canonical_human():
    assert played("plain", episodes=500).summary.success.mean() == 1.0


def test_a_planted_robot_fails_whoever_shows_its_weakness_and_nobody_else(planted):
    weakness = planted["right"]
    episodes = played("plain", Watcher(weakness.sees, gives_up=True), episodes=500)
    seen = shown(weakness, paths(episodes))
    assert np.array_equal(episodes.summary.success == 0, seen)


def test_a_decoy_meets_whoever_shows_what_its_twin_cannot_bear(planted):
    weakness = planted["right"]
    episodes = played("plain", Watcher(weakness.sees, gives_up=False), episodes=500)
    assert shown(weakness, paths(episodes)).any()
    assert episodes.summary.success.mean() == 1.0


def test_planted_robot_and_decoy_act_alike_until_the_weakness_is_seen(planted):
    weakness = planted["left"]
    one, other = (
        played("plain", Watcher(weakness.sees, gives_up=gives_up), episodes=200)
        for gives_up in (True, False)
    )
    unseen = ~shown(weakness, paths(one))
    assert np.array_equal(one.robot_action[:, unseen], other.robot_action[:, unseen])

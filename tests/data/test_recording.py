"""What is recorded depends on the seed alone, and is what the human did."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.data.episodes import data_hash, load_episodes, save_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.policies.passive import PassivePolicy
from rigid.tasks.itch_scratching.task import ItchScratching
from rigid.tasks.protocol import AgentSpec
from tests.toys import SPEED, Follower, Pointer, ToyReach, untrained

TASK = ToyReach()
PER_EPISODE = ("features", "observations", "actions", "seeds", "returns", "success")


def play(episodes=5, seed=0, batch=4, task=TASK, human=None, **provenance):
    human = human or Pointer()
    return record(
        task, Follower(), human, episodes=episodes, seed=seed, batch=batch, provenance=provenance
    )


def test_the_same_seed_gives_the_same_episodes():
    human = untrained(TASK.human, memory=2)
    assert data_hash(play(human=human)) == data_hash(play(human=human))


def test_another_seed_gives_other_starts_and_other_noise():
    one, other = play(seed=0), play(seed=1)
    assert not np.intersect1d(one.seeds, other.seeds).size
    assert not np.array_equal(one.actions, other.actions)


@pytest.mark.parametrize("shorter", [1, 4, 5, 8])
def test_a_longer_recording_begins_with_the_shorter_one(shorter):
    human = untrained(TASK.human)
    short, long = play(shorter, human=human), play(9, human=human)
    for name in PER_EPISODE:
        np.testing.assert_array_equal(getattr(short, name), getattr(long, name)[:shorter])


def test_no_two_episodes_share_start_or_noise():
    episodes = play(9, human=untrained(TASK.human))
    assert len(np.unique(episodes.seeds)) == 9
    assert len(np.unique(episodes.actions[..., 0], axis=0)) == 9


def test_the_natural_pair_does_what_it_should():
    episodes = play(9)
    hand, goal = episodes.features[..., 0], episodes.features[..., 1]
    assert (episodes.success == 1).all()
    np.testing.assert_allclose(hand[:, -1], goal[:, -1], atol=0.1)
    assert set(np.unique(goal)) == {-1.0, 1.0}


@pytest.mark.parametrize(("choices", "kept"), [((), (1.0, 1.0)), ((2,), (1.0, -1.0))])
def test_actions_are_kept_as_the_task_takes_them(choices, kept):
    class Loud(Pointer):
        def act(self, observation, state, rng):
            del rng
            return np.tile([3.0, 2.0], (len(observation), 1)), state

    task, loud = ToyReach(), Loud()
    task.human = AgentSpec(3, 2, ("robot", "hand", "goal"), choices=choices)
    found = play(task=task, human=loud).actions.reshape(-1, 2)
    np.testing.assert_array_equal(found, np.tile(kept, (len(found), 1)))


def test_features_are_of_the_state_that_the_action_led_to():
    episodes = play()
    hand = episodes.observations[..., 1] + SPEED * np.clip(episodes.actions[..., 0], -1, 1)
    np.testing.assert_allclose(episodes.features[..., 0], hand, atol=1e-6)


def test_the_human_is_sampled_and_the_robot_is_not():
    episodes = play(human=Pointer(noise=0.0))
    by_goal = episodes.features[:, 0, 1]
    for goal in np.unique(by_goal):
        same = episodes.features[by_goal == goal]
        np.testing.assert_array_equal(same, np.broadcast_to(same[0], same.shape))
    assert len(np.unique(play(human=Pointer()).actions[:, -1, 0])) == 5


def test_the_recording_says_where_it_comes_from(tmp_path):
    episodes = play(robot="abc", human_hash="def")
    assert episodes.provenance == {
        "robot": "abc",
        "human_hash": "def",
        "seed": 0,
        "batch": 4,
        "faulted_episodes": 0,
    }
    assert (episodes.source, episodes.task) == ("synthetic", TASK.describe())
    save_episodes(tmp_path / "canonical.npz", episodes)
    assert data_hash(load_episodes(tmp_path / "canonical.npz", task=TASK)) == data_hash(episodes)


def test_the_recording_keeps_the_units_that_its_task_knows():
    task = ToyReach()
    task.feature_units = {"hand": "m"}
    assert play(task=task).about.units == {"hand": "m"}
    assert play().about.units == {}


def test_episodes_that_ran_away_are_replaced_by_the_next_and_counted():
    sound = play(20)
    episodes = play(9, task=ToyReach(fault_every=3))
    kept = sound.seeds % 3 != 0
    np.testing.assert_array_equal(episodes.seeds, sound.seeds[kept][:9])
    np.testing.assert_array_equal(episodes.features, sound.features[kept][:9])
    before_the_last = np.flatnonzero(kept)[8]
    assert episodes.provenance["faulted_episodes"] == np.sum(~kept[:before_the_last]) > 0


def test_a_task_that_always_runs_away_is_refused():
    with pytest.raises(UserError, match="12 of 12 episodes of task 'toy-reach' ran away: record"):
        play(task=ToyReach(fault_every=1))


@pytest.mark.parametrize(
    ("name", "value", "least"), [("episodes", 0, 1), ("seed", -1, 0), ("batch", 0, 1)]
)
def test_a_number_out_of_range_is_named(name, value, least):
    with pytest.raises(ValueError, match=f"{name} must be at least {least}, got {value}"):
        play(**{name: value})


def test_itch_scratching_can_be_recorded(tmp_path):
    task = ItchScratching()
    robot = untrained(task.robot)
    human = PassivePolicy(task.human.observation_size, task.human.action_size)
    episodes = record(task, robot, human, episodes=4, seed=0, batch=4, provenance={})
    assert episodes.features.shape == (4, 100, 22)
    np.testing.assert_allclose(episodes.features[..., -2:].sum(axis=-1), 1.0)
    save_episodes(tmp_path / "canonical.npz", episodes)
    assert data_hash(load_episodes(tmp_path / "canonical.npz", task=task)) == data_hash(episodes)

"""Whoever ends an episode early gains nothing by it: neither reward nor naturalness."""

import numpy as np
import pytest

from rigid.tasks.bridges.padding import Moment, Padding


def moment(values, *, ended=(), reward=0.0):
    """One world for each value, which is all that it shows."""
    rows = np.asarray(values, float)[:, None]
    count = len(values)
    over = np.isin(np.arange(count), ended)
    return Moment(rows, rows + 100, np.full(count, reward), rows, over, {"x": rows[:, 0]})


def played(horizon, lives, *, reward=1.0):
    """Worlds that live so long and show 1, 2, 3, …; what they say afterwards is nonsense."""
    padding = Padding(horizon, moment([0.0] * len(lives)))
    steps = []
    for time in range(1, horizon + 1):
        over = [world for world, life in enumerate(lives) if life == time]
        values = [time if time <= life else np.nan for life in lives]
        steps.append(padding.after(moment(values, ended=over, reward=reward)))
    return padding, steps


@pytest.mark.parametrize("reward", [1.0, -1.0])
def test_the_return_is_the_environments_own(reward):
    _, steps = played(6, [2, 6, 1], reward=reward)
    returns = sum(step.reward for step in steps)
    np.testing.assert_array_equal(returns, reward * np.array([2, 6, 1]))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_reward_for_looking_natural_is_the_same_for_an_episode_that_ends(sign):
    # An onlooker gives or takes 1 for every moment of odd number. A life of ten such moments and
    # five that are as odd get the same over the horizon, whether all is gain or all is loss.
    _, steps = played(20, [20, 10, 4])
    seen = np.stack([step.features[:, 0] for step in steps])
    judged = sign * (seen % 2).sum(axis=0)
    np.testing.assert_array_equal(judged, sign * 10)


@pytest.mark.parametrize("life", [1, 3, 7, 9, 16, 19])
def test_every_lived_step_comes_up_equally_often_up_to_one(life):
    _, steps = played(20, [life])
    seen = np.array([step.features[0, 0] for step in steps], int)
    np.testing.assert_array_equal(seen[:life], np.arange(1, life + 1))
    counts = np.bincount(seen)[1:]
    assert len(counts) == life
    assert np.ptp(counts) <= 1


def test_no_part_of_a_life_is_favoured_when_only_some_of_it_fits():
    _, steps = played(20, [15])
    repeated = [int(step.features[0, 0]) for step in steps[15:]]
    assert repeated == [2, 5, 8, 11, 14]


def test_observations_are_held():
    _, steps = played(6, [2, 6])
    np.testing.assert_array_equal([step.robot_observation[0, 0] for step in steps], [1, *[2] * 5])
    np.testing.assert_array_equal([s.human_observation[0, 0] for s in steps], [101, *[102] * 5])
    np.testing.assert_array_equal([step.info["x"][0] for step in steps], [1, *[2] * 5])


def test_only_worlds_that_go_on_are_to_be_stepped():
    padding = Padding(3, moment([0.0, 0.0]))
    np.testing.assert_array_equal(padding.running, [True, True])
    padding.after(moment([1.0, 1.0], ended=[1]))
    np.testing.assert_array_equal(padding.running, [True, False])
    padding.after(moment([2.0, 2.0]))
    padding.after(moment([3.0, 3.0]))
    np.testing.assert_array_equal(padding.running, [False, False])
    np.testing.assert_array_equal(padding.lived, [3, 1])
    np.testing.assert_array_equal(padding.ended_early, [False, True])


def test_an_episode_that_ends_at_the_horizon_did_not_end_early():
    padding, _ = played(3, [3])
    assert not padding.ended_early.any()


def test_a_number_that_is_not_finite_is_a_fault_from_then_on():
    padding = Padding(4, moment([0.0, 0.0]))
    steps = [padding.after(moment([1.0, 1.0], reward=1.0))]
    steps.append(padding.after(moment([np.nan, 2.0], reward=1.0)))
    steps.append(padding.after(moment([3.0, 3.0], reward=1.0)))
    np.testing.assert_array_equal([step.faulted[0] for step in steps], [False, True, True])
    np.testing.assert_array_equal([step.reward[0] for step in steps], [1.0, 0.0, 0.0])
    np.testing.assert_array_equal([step.robot_observation[0, 0] for step in steps], [1, 1, 1])
    assert not any(step.faulted[1] for step in steps)
    assert np.isfinite([step.features for step in steps]).all()


def test_steps_do_not_change_afterwards():
    padding = Padding(3, moment([0.0]))
    first = padding.after(moment([1.0]))
    padding.after(moment([2.0]))
    assert first.features.item() == 1.0
    assert first.robot_observation.item() == 1.0

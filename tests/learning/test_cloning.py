"""A cloned human has gain and noise of the one it was cloned from, clipped actions or not."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest

from rigid.learning.censored import calibrated, censored_log_likelihood
from rigid.learning.cloning import (
    CloningSettings,
    Pairs,
    clone,
    compare,
    divide,
    log_likelihood,
)
from rigid.policies.gaussian import mean_action

QUICK = CloningSettings(hidden=(), learning_rate=0.02, block=50, blocks=12, patience=4)
"""A linear human needs no hidden layer; the known answer is met within seconds."""


def linear_people(count, *, gain=(0.6, -0.3), std=0.2, seed=0):
    """Steps of a human who acts `gain` · seen + noise, clipped as the task clips."""
    rng = np.random.default_rng(seed)
    seen = rng.standard_normal((count, 2)).astype(np.float32)
    done = seen @ np.array(gain)[:, None] + std * rng.standard_normal((count, 1))
    return Pairs(jnp.asarray(seen), jnp.asarray(np.clip(done, -1, 1), jnp.float32))


@pytest.mark.parametrize("std", [0.05, 0.6])
def test_gain_and_noise_of_a_linear_human_are_recovered(std):
    train, validation = (linear_people(3000, std=std, seed=seed) for seed in (0, 1))
    found = clone(train, validation, QUICK, seed=0)
    probes = jnp.asarray(np.array([[0, 0], [1, 0], [0, 1]], np.float32))
    level, *ends = np.asarray(mean_action(found, probes))[:, 0]
    # At 0.6 a sixth of the actions is clipped: a plain Gaussian would say 0.5 for the first gain.
    np.testing.assert_allclose([level, *(np.array(ends) - level)], [0, 0.6, -0.3], atol=0.04)
    assert np.exp(found.log_std[0]) == pytest.approx(std, rel=0.06)


def test_the_likelihood_of_clipped_actions_is_that_of_everything_beyond():
    mean, log_std = np.zeros((3, 1)), np.zeros(1)
    action = np.array([[1.0], [-1.0], [0.5]])
    found = censored_log_likelihood(mean, log_std, action, np)[:, 0]
    # log P(a >= 1) of a standard Gaussian, twice; log of its density at 0.5.
    np.testing.assert_allclose(found, [-1.841022, -1.841022, -1.043939], atol=1e-5)


def test_without_noise_the_least_deviation_stands():
    zero = np.zeros((50, 2))
    np.testing.assert_allclose(np.exp(calibrated(zero, zero, 0.01)), 0.01, rtol=1e-3)


def test_a_clone_is_compared_with_the_mean_and_with_the_last_action():
    train, test = linear_people(2000, std=0.2), linear_people(400, std=0.2, seed=2)
    found = clone(train, linear_people(500, seed=1), QUICK, seed=0)
    likely = compare(found, train, test, 20, QUICK)
    assert likely.clone == log_likelihood(found, test)
    assert likely.clone > likely.mean_action > likely.last_action  # Steps are independent here.


def test_people_are_held_out_as_a_whole():
    who = [f"P{i % 5}" for i in range(40)]
    parts = divide(40, who, CloningSettings(), seed=0)
    groups = [{who[i] for i in part} for part in parts[:3]]
    assert parts.by == "participant"
    assert [len(group) for group in groups] == [3, 1, 1]
    assert set.union(*groups) == set(who)


@pytest.mark.parametrize("who", [[], ["P1"] * 40, ["P1", "P2"] * 20, ["P1", ""] * 20])
def test_where_fewer_than_three_people_are_known_episodes_are_held_out(who):
    parts = divide(40, who, CloningSettings(), seed=0)
    assert parts.by == "episode"
    assert [len(part) for part in parts[:3]] == [24, 8, 8]
    assert sorted(np.concatenate(parts[:3])) == list(range(40))

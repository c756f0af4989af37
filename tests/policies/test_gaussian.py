"""The Gaussian policy: density, noise, memory, and groups that act as their members would."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import norm

from rigid.policies.gaussian import (
    GaussianParameters,
    GaussianPolicy,
    group_mean_action,
    history_windows,
    init_gaussian,
    log_density,
    mean_action,
    stack_history,
    with_memory,
)
from rigid.policies.networks import Normaliser, init_normaliser
from rigid.tasks.protocol import AgentSpec
from tests.toys import untrained

SPEC = AgentSpec(3, 2)


def linear(weights, std=0.5, memory=1):
    """A policy whose mean action is `weights` applied to what it sees."""
    weights = jnp.asarray(weights, jnp.float32)
    seen, actions = weights.shape
    parameters = GaussianParameters(
        [{"w": weights, "b": jnp.zeros(actions)}],
        jnp.full(actions, np.log(std), jnp.float32),
        init_normaliser(seen),
    )
    return GaussianPolicy(parameters, memory=memory)


def look(batch=4, seed=0):
    return np.random.default_rng(seed).standard_normal((batch, 3)).astype(np.float32)


def test_log_density_is_that_of_independent_normals():
    rng = np.random.default_rng(0)
    mean, action = rng.standard_normal((2, 5, 4, 3)).astype(np.float32)
    log_std = np.log([0.1, 1.0, 3.0]).astype(np.float32)
    expected = norm.logpdf(action, mean, np.exp(log_std)).sum(axis=-1)
    found = log_density(jnp.asarray(mean), jnp.asarray(log_std), jnp.asarray(action))
    np.testing.assert_allclose(found, expected, rtol=1e-4)


def test_without_a_generator_it_acts_by_its_mean():
    policy = untrained(SPEC)
    action, _ = policy.act(look(), (), None)
    np.testing.assert_allclose(
        action, mean_action(policy.parameters, jnp.asarray(look())), rtol=1e-6
    )


def test_it_sees_normalised_observations():
    policy = linear(np.eye(3))
    moments = Normaliser(jnp.array([1.0, 2.0, 3.0]), jnp.array([4.0, 4.0, 4.0]), jnp.array(9.0))
    policy.parameters = policy.parameters._replace(normaliser=moments)
    action, _ = policy.sample(np.array([[2.0, 2.0, 2.0]], np.float32), (), None)
    np.testing.assert_allclose(action, [[0.5, 0.0, -0.5]], atol=1e-6)


def test_the_same_seed_gives_the_same_actions():
    policy = untrained(SPEC)
    first, again, other = (
        policy.sample(look(), (), np.random.default_rng(seed))[0] for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first, again)
    assert (first != other).all()


def test_the_noise_has_the_deviation_of_each_action():
    policy = linear(np.zeros((3, 2)))
    policy = GaussianPolicy(policy.parameters._replace(log_std=jnp.log(jnp.array([0.1, 2.0]))))
    action, _ = policy.sample(look(20_000), (), np.random.default_rng(0))
    np.testing.assert_allclose(action.mean(axis=0), 0, atol=0.05)
    np.testing.assert_allclose(action.std(axis=0), [0.1, 2.0], rtol=0.03)


def test_acts_are_samples_so_that_the_task_chooses_as_in_training():
    policy, seen = linear([[3.0]]), np.array([[-1.0], [0.1], [1.0]], np.float32)
    assert policy.act(seen, (), None)[0].ravel() == pytest.approx([-3.0, 0.3, 3.0], rel=1e-5)
    drawn = [f(seen, (), np.random.default_rng(0))[0] for f in (policy.act, policy.sample)]
    np.testing.assert_array_equal(*drawn)


def test_the_window_is_newest_first_and_repeats_the_oldest():
    """A policy that shows the three numbers that it sees, of an observation that counts up."""
    policy = linear(np.eye(3), memory=3)
    state, seen = policy.initial_state(2), []
    for number in range(4):
        observation = np.array([[number], [10 * number]], np.float32)
        window, state = policy.sample(observation / 100, state, None)
        seen.append(np.round(100 * window).astype(int).tolist())
    assert [rows[0] for rows in seen] == [[0, 0, 0], [1, 0, 0], [2, 1, 0], [3, 2, 1]]
    assert [rows[1] for rows in seen] == [[0, 0, 0], [10, 0, 0], [20, 10, 0], [30, 20, 10]]


def test_a_missing_past_is_filled_world_by_world():
    past = np.array([[1.0, 2.0, np.nan, np.nan], [np.nan] * 4, [1.0, 2.0, 3.0, 4.0]])
    window = stack_history(np.array([[8.0, 9.0]] * 3), past)
    np.testing.assert_array_equal(
        window, [[8, 9, 1, 2, 1, 2], [8, 9, 8, 9, 8, 9], [8, 9, 1, 2, 3, 4]]
    )


def test_windows_of_history_are_those_the_policy_acts_on():
    observation = np.random.default_rng(0).standard_normal((5, 4, 2)).astype(np.float32)
    windows, past = history_windows(observation, 3), np.full((4, 4), np.nan, np.float32)
    for seen, window in zip(observation, windows, strict=True):
        expected = stack_history(seen, past)
        np.testing.assert_array_equal(window, expected)
        past = expected[:, :-2]


def test_a_policy_that_is_given_memory_acts_as_before_whatever_the_past_was():
    plain = untrained(SPEC)
    given = with_memory(plain.parameters, 3)
    past = np.random.default_rng(1).standard_normal((4, 6)).astype(np.float32)
    found = mean_action(given, jnp.asarray(np.concatenate([look(), past], axis=1)))
    np.testing.assert_allclose(found, plain.act(look(), (), None)[0], rtol=1e-5, atol=1e-6)


def test_a_policy_without_memory_carries_nothing():
    policy = untrained(SPEC)
    assert policy.initial_state(4) == ()
    assert policy.act(look(), (), None)[1] == ()


def test_a_window_of_two_starts_with_a_state_of_one_observation():
    policy = untrained(SPEC, memory=2)
    assert (policy.observation_size, policy.action_size) == (3, 2)
    assert policy.initial_state(4).shape == (4, 3)


def test_a_group_acts_as_each_policy_alone():
    policies = [untrained(SPEC, seed=seed).parameters for seed in range(3)]
    seen = jnp.asarray(look(12).reshape(3, 4, 3))
    stacked = jax.tree.map(lambda *leaves: jnp.stack(leaves), *policies)
    together = group_mean_action(stacked, seen)
    for policy, rows, found in zip(policies, seen, together, strict=True):
        np.testing.assert_allclose(found, mean_action(policy, rows), rtol=1e-5, atol=1e-6)


def test_a_new_policy_hardly_moves_and_has_the_noise_asked_for():
    parameters = init_gaussian(jax.random.key(0), 3, 2, (8,), std=0.3, memory=2)
    policy = GaussianPolicy(parameters, memory=2)
    action, _ = policy.act(look(), policy.initial_state(4), None)
    assert np.abs(action).max() < 0.05
    np.testing.assert_allclose(np.exp(parameters.log_std), 0.3, rtol=1e-6)

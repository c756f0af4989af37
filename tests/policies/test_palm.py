"""PALM acts on its newest observation and on what it makes of the last few."""

from __future__ import annotations

import cloudpickle
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.policies.gaussian import GaussianPolicy, history_windows
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.native import save_policy
from rigid.policies.palm import encode, with_latent
from rigid.policies.protocol import Policy
from tests.toys import ToyReach, untrained_palm

TASK = ToyReach()
POLICY = untrained_palm(TASK.robot)
SEEN = np.random.default_rng(1).standard_normal((6, 4, 2)).astype(np.float32)


def acts(policy, rng=None, seen=SEEN):
    """Actions of one set of episodes, shape (T, B, a)."""
    state, actions = policy.initial_state(seen.shape[1]), []
    for observation in seen:
        action, state = policy.act(observation, state, rng)
        actions.append(action)
    return np.array(actions)


def test_it_is_a_policy():
    assert isinstance(POLICY, Policy)
    assert (POLICY.observation_size, POLICY.action_size) == (2, 1)


def test_it_acts_on_the_newest_observation_and_the_latent_of_the_last_four():
    windows = history_windows(SEEN, 4)
    head = GaussianPolicy(POLICY.parameters.head)
    given = np.asarray(with_latent(POLICY.parameters.encoder, jnp.asarray(windows)))
    np.testing.assert_array_equal(given[..., :2], SEEN)
    expected = [head.act(rows, (), None)[0] for rows in given]
    np.testing.assert_allclose(acts(POLICY), expected, atol=1e-6)


def test_what_is_older_than_its_memory_changes_nothing():
    other = SEEN.copy()
    other[0] += 1.0
    changed = np.abs(acts(POLICY) - acts(POLICY, seen=other)).max(axis=(1, 2)) > 0
    assert changed.tolist() == [True] * 4 + [False] * 2


def test_the_latent_reads_time_forwards():
    """The same observations in another order are another motion."""
    encoder = POLICY.parameters.encoder
    window = jnp.asarray(SEEN[:4, 0].reshape(-1))
    backwards = jnp.asarray(SEEN[3::-1, 0].reshape(-1))
    assert np.abs(np.asarray(encode(encoder, window) - encode(encoder, backwards))).max() > 1e-3


def test_noise_is_drawn_only_with_a_generator():
    np.testing.assert_array_equal(acts(POLICY), acts(POLICY))
    noisy = acts(POLICY, np.random.default_rng(0))
    assert np.abs(noisy - acts(POLICY)).max() > 0


def test_a_directory_is_loaded_with_the_hash_of_what_was_saved(tmp_path):
    save_policy(POLICY, tmp_path, agent="robot", task=TASK.describe(), provenance={})
    loaded = load_policy(str(tmp_path), task=TASK, agent="robot")
    np.testing.assert_array_equal(acts(loaded), acts(POLICY))
    assert policy_hash(loaded) == policy_hash(POLICY) == policy_hash(tmp_path)
    assert policy_hash(untrained_palm(TASK.robot, seed=1)) != policy_hash(POLICY)


def test_it_can_be_sent_to_another_process():
    sent = cloudpickle.loads(cloudpickle.dumps(POLICY))
    np.testing.assert_array_equal(acts(sent), acts(POLICY))


@pytest.mark.parametrize("memory", [1, 2])
def test_any_memory_will_do(memory):
    assert acts(untrained_palm(TASK.robot, memory=memory)).shape == (6, 4, 1)

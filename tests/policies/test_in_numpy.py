"""A policy in NumPy acts as the same policy in JAX."""

import numpy as np
import pytest

from rigid.policies.gaussian import GaussianPolicy, with_memory
from rigid.policies.in_numpy import in_numpy
from rigid.policies.loading import load_policy
from rigid.policies.passive import PassivePolicy
from rigid.policies.protocol import Policy
from rigid.tasks.registry import make_task
from tests.toys import ToyReach, untrained_palm


def same(policy, seen, seed=None):
    """Largest difference of what both do with a row of observations, as a task takes actions."""
    prompt = in_numpy(policy)
    states, rngs = (policy.initial_state(1), prompt.initial_state(1)), [None, None]
    if seed is not None:
        rngs = [np.random.default_rng(seed) for _ in range(2)]
    apart = []
    for row in seen:
        ours, one = policy.act(row[None], states[0], rngs[0])
        theirs, other = prompt.act(row[None], states[1], rngs[1])
        np.testing.assert_array_equal(one, other)
        apart.append(np.abs(np.clip(ours, -1, 1) - np.clip(theirs, -1, 1)).max())
        states = one, other
    return max(apart)


def observations(size, count=50):
    return np.random.default_rng(0).standard_normal((count, size)).astype(np.float32)


@pytest.mark.parametrize("name", ["itch-scratching", "feeding"])
@pytest.mark.parametrize(
    ("agent", "spec"), [("robot", "builtin:vanilla"), ("human", "builtin:synthetic-human")]
)
def test_bundled_policies_act_alike_to_a_millionth(name, agent, spec):
    policy = load_policy(spec, task=make_task(name), agent=agent)
    assert same(policy, observations(policy.observation_size)) < 1e-6


def test_so_does_a_policy_with_memory():
    policy = load_policy("builtin:vanilla", task=make_task("itch-scratching"))
    remembering = GaussianPolicy(with_memory(policy.parameters, 3), memory=3)
    assert same(remembering, observations(policy.observation_size)) < 1e-6


def test_so_does_palm():
    assert same(untrained_palm(ToyReach().robot), observations(2)) < 1e-6


def test_noise_is_the_same_noise():
    policy = load_policy("builtin:vanilla", task=make_task("feeding"))
    assert same(policy, observations(policy.observation_size), seed=5) < 1e-6


def test_it_is_a_policy_and_foreign_ones_are_left_alone():
    policy = untrained_palm(ToyReach().robot)
    assert isinstance(in_numpy(policy), Policy)
    passive = PassivePolicy(2, 1)
    assert in_numpy(passive) is passive

"""What a learner is: what its critic is given, and whose noise it acts with."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np

from rigid.learning.learner import with_noise, with_time
from rigid.learning.ppo import PPOSettings, init_learner
from rigid.policies.networks import Normaliser
from tests.learning.reach import bitwise_equal


def test_the_critic_sees_the_time_left_behind_the_standardised_observation():
    moments = Normaliser(jnp.array([1.0]), jnp.array([4.0]), jnp.asarray(1.0))
    seen = with_time(moments, jnp.full((4, 2, 1), 5.0))
    np.testing.assert_allclose(seen[:, :, 0], 2.0, rtol=1e-6)
    np.testing.assert_allclose(seen[:, 1, 1], [1, 0.75, 0.5, 0.25])


def test_noise_that_is_set_changes_nothing_else():
    learner = init_learner(
        jax.random.key(0), PPOSettings(), observation_size=2, critic_observation_size=2,
        action_size=3, hidden=(4,),
    )  # fmt: skip
    louder = with_noise(learner, 0.2)
    np.testing.assert_allclose(np.exp(louder.policy.log_std), [0.2] * 3, rtol=1e-6)
    assert bitwise_equal(louder.policy.network, learner.policy.network)
    assert bitwise_equal(louder[1:], learner[1:])

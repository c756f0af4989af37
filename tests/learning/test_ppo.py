"""PPO on probe tasks of known answer: two steps, one number to see, one to act with."""

from __future__ import annotations

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.learning.advantages import standardised
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.best_response import ResponseSettings
from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.learner import Rollout, critic_values, trainable_of, with_noise
from rigid.learning.personalisation import PersonalisationSettings
from rigid.learning.ppo import PPOSettings, _loss, init_learner, ppo_update
from rigid.policies.gaussian import GaussianPolicy
from tests.learning.reach import bitwise_equal

STEPS, EPISODES = 2, 128
SETTINGS = PPOSettings(
    learning_rate=1e-2, gamma=0.5, gae_lambda=1.0, minibatch=64, epochs=4, update_normaliser=False
)
CLONING = PPOSettings(
    learning_rate=1e-2,
    minibatch=64,
    epochs=4,
    policy_coefficient=0.0,
    cloning_coefficient=1.0,
)

_update = jax.jit(ppo_update, static_argnames="settings")


def fresh(settings=SETTINGS, std=0.5):
    return init_learner(
        jax.random.key(0),
        settings,
        observation_size=1,
        critic_observation_size=1,
        action_size=1,
        hidden=(16,),
        std=std,
    )


def rollout(learner, rng, observation, reward_of, **changes):
    """Samples actions and asks `reward_of(observation, action)`; arrays are (steps, episodes)."""
    flat = observation.reshape(-1, 1).astype(np.float32)
    action = GaussianPolicy(learner.policy).sample(flat, (), rng)[0].reshape(STEPS, EPISODES)
    seen, acted = (jnp.asarray(x, jnp.float32)[..., None] for x in (observation, action))
    reward = jnp.asarray(reward_of(observation, action), jnp.float32)
    one = Rollout(seen, seen, acted, reward, jnp.ones_like(reward), jnp.zeros_like(acted))
    return one._replace(**changes)


def nothing(rng):
    del rng
    return np.zeros((STEPS, EPISODES))


def a_sign(rng):
    """±1, the same in both steps."""
    return np.tile(rng.choice([-1.0, 1.0], EPISODES), (STEPS, 1))


def learn(reward_of, observe=nothing, *, iterations=40):
    learner, rng = with_noise(fresh(), 0.3), np.random.default_rng(0)
    for iteration in range(iterations):
        played = rollout(learner, rng, observe(rng), reward_of)
        learner, _ = _update(learner, played, jax.random.key(iteration), settings=SETTINGS)
    return learner


def value(learner, observation):
    """The critic's values of both steps."""
    return critic_values(learner, jnp.full((STEPS, 1, 1), observation, jnp.float32))[:, 0]


def mean(learner, *observations):
    rows = np.array(observations, np.float32)[:, None]
    return GaussianPolicy(learner.policy).sample(rows, (), None)[0][:, 0]


def test_a_constant_reward_teaches_the_critic_the_time_left():
    learner = learn(lambda observation, _: np.ones_like(observation))
    np.testing.assert_allclose(value(learner, 0.0), [1 + 0.5, 1], atol=0.1)


def test_a_reward_that_depends_on_the_observation_teaches_the_critic_to_look():
    learner = learn(lambda observation, _: observation, a_sign)
    np.testing.assert_allclose(value(learner, 1.0), [1.5, 1], atol=0.15)
    np.testing.assert_allclose(value(learner, -1.0), [-1.5, -1], atol=0.15)


def test_a_reward_that_depends_on_the_action_moves_the_policy_there():
    learner = learn(lambda _, action: -((action - 0.6) ** 2))
    assert mean(learner, 0.0) == pytest.approx(0.6, abs=0.1)


def test_the_best_action_is_read_from_the_observation():
    learner = learn(lambda observation, action: -((action - 0.6 * observation) ** 2), a_sign)
    assert mean(learner, -1.0, 1.0) == pytest.approx([-0.6, 0.6], abs=0.12)


def test_a_delayed_reward_is_discounted_by_gamma():
    """The first action costs (a + .6)² now and 4 (a - .6)² later: best at .6 (4γ - 1) / (4γ + 1).

    γ = ½ gives .2; a blind robot would choose -.6, one without discount .36.
    """

    def reward_of(_, action):
        return np.stack([-((action[0] + 0.6) ** 2), -4 * (action[0] - 0.6) ** 2])

    learner = learn(reward_of, iterations=60)
    assert mean(learner, 0.0) == pytest.approx(0.2, abs=0.1)


@pytest.mark.parametrize(
    "recipe",
    [AdversarySettings, CoOptimisationSettings, PersonalisationSettings, ResponseSettings],
)
def test_every_recipe_looks_over_a_whole_episode(recipe):
    """A reward 100 steps ahead still counts for a third; γ = .9 would see ten steps."""
    assert recipe().ppo.gamma ** 100 == pytest.approx(0.366, abs=0.001)


@pytest.mark.parametrize("settings", [SETTINGS, CLONING], ids=["reward", "cloning"])
def test_steps_after_a_fault_do_not_move_anything(settings):
    learner, rng = fresh(settings), np.random.default_rng(0)
    weight = jnp.ones((STEPS, EPISODES)).at[1, ::3].set(0.0)
    played = rollout(learner, rng, a_sign(rng), lambda _, action: action, weight=weight)
    lost = weight[..., None] == 0
    ruined = played._replace(
        reward=jnp.where(weight > 0, played.reward, 1e9),
        action=jnp.where(lost, 1e3, played.action),
        expert_action=jnp.where(lost, 1e3, played.expert_action),
    )
    one, other = (
        _update(learner, x, jax.random.key(0), settings=settings)[0] for x in (played, ruined)
    )
    assert bitwise_equal(one, other)
    assert not bitwise_equal(one, learner)


def test_lost_episodes_are_as_if_they_had_not_been_played():
    """In batches of everything, with advantages whose size sets the pace."""
    settings = replace(SETTINGS, minibatch=STEPS * EPISODES, signal_floor=100.0)
    learner, rng = fresh(settings), np.random.default_rng(0)
    half = EPISODES // 2
    weight = jnp.ones((STEPS, EPISODES)).at[:, half:].set(0.0)
    played = rollout(learner, rng, a_sign(rng), lambda _, action: 3 + action, weight=weight)
    sound = Rollout(*(rows[:, :half] for rows in played))
    one, other = (
        _update(learner, rows, jax.random.key(0), settings=settings)[0] for rows in (played, sound)
    )
    for part in ("policy", "critic"):
        before, *after = (jax.tree.leaves(getattr(x, part)) for x in (learner, one, other))
        for start, left, right in zip(before, *after, strict=True):
            np.testing.assert_allclose(left - start, right - start, rtol=0.01, atol=1e-6)


def test_lost_samples_count_in_no_mean_of_the_loss():
    """Half of a batch is lost: every term is that of the other half."""
    learner, rng = fresh(CLONING), np.random.default_rng(0)
    batch = {
        name: jnp.asarray(rng.standard_normal(shape), jnp.float32)
        for name, shape in (
            ("observation", (8, 1)), ("critic", (8, 2)), ("action", (8, 1)), ("expert", (8, 1)),
            ("log_density", (8,)), ("advantage", (8,)), ("target", (8,)),
        )
    }  # fmt: skip
    batch["weight"] = jnp.tile(jnp.array([1.0, 0.0]), 4)
    sound = {name: values[::2] for name, values in batch.items()}
    trainable = trainable_of(learner.policy, learner.critic)
    found, expected = (_loss(trainable, rows, PPOSettings())[1] for rows in (batch, sound))
    for name in ("policy", "value", "cloning"):
        assert getattr(found, name) == pytest.approx(float(getattr(expected, name)), rel=1e-5), name


def test_what_was_seen_in_lost_episodes_does_not_move_anything():
    learner, rng = fresh(), np.random.default_rng(0)
    weight = jnp.ones((STEPS, EPISODES)).at[:, ::3].set(0.0)
    played = rollout(learner, rng, a_sign(rng), lambda _, action: action, weight=weight)
    seen = jnp.where(weight[..., None] > 0, played.observation, 5.0)
    ruined = played._replace(observation=seen, critic_observation=seen)
    one, other = (
        _update(learner, x, jax.random.key(0), settings=SETTINGS)[0] for x in (played, ruined)
    )
    assert bitwise_equal(one, other)


def test_advantages_are_standardised_over_sound_steps_alone():
    gain, weight = jnp.array([[1.0, 3.0], [0.0, 0.0]]), jnp.array([[1.0, 1.0], [0.0, 0.0]])
    np.testing.assert_allclose(standardised(gain, weight)[0], [-1, 1], rtol=1e-5)


def test_episodes_that_were_lost_from_the_start_teach_nothing():
    learner, rng = fresh(), np.random.default_rng(0)
    lost = jnp.zeros((STEPS, EPISODES))
    played = rollout(learner, rng, nothing(rng), lambda _, action: action, weight=lost)
    after, _ = _update(learner, played, jax.random.key(0), settings=SETTINGS)
    assert bitwise_equal(after.policy, learner.policy)
    assert bitwise_equal(after.critic, learner.critic)


def test_the_noise_is_the_callers_to_set():
    learner, rng = with_noise(fresh(), 0.3), np.random.default_rng(0)
    np.testing.assert_allclose(np.exp(learner.policy.log_std), 0.3, rtol=1e-6)
    played = rollout(learner, rng, nothing(rng), lambda _, action: -((action - 5) ** 2))
    after, _ = _update(learner, played, jax.random.key(0), settings=SETTINGS)
    assert bitwise_equal(after.policy.log_std, learner.policy.log_std)
    assert not bitwise_equal(after.policy.network, learner.policy.network)


def test_cloning_alone_drives_the_mean_action_to_the_experts():
    """Whatever the reward says: the expert's action is ½ - ⅓ of what it sees."""
    learner, rng = fresh(CLONING), np.random.default_rng(0)
    for iteration in range(40):
        observation = rng.uniform(-1, 1, (STEPS, EPISODES))
        expert = jnp.asarray(0.5 - observation / 3, jnp.float32)[..., None]
        played = rollout(
            learner, rng, observation, lambda _, action: 10 * action, expert_action=expert
        )
        learner, losses = _update(learner, played, jax.random.key(iteration), settings=CLONING)
    assert losses.cloning < 1e-3
    assert mean(learner, -0.9, 0.0, 0.9) == pytest.approx([0.8, 0.5, 0.2], abs=0.05)


def test_running_moments_are_those_of_all_rollouts_seen():
    learner, rng = fresh(CLONING), np.random.default_rng(0)
    seen = [rng.normal(3, 2, (STEPS, EPISODES)) for _ in range(2)]
    for observation in seen:
        played = rollout(learner, rng, observation, lambda _, action: action)
        learner, _ = _update(learner, played, jax.random.key(0), settings=CLONING)
    for moments in (learner.policy.normaliser, learner.critic_normaliser):
        assert moments.mean == pytest.approx(np.mean(seen), rel=1e-3)
        assert moments.variance == pytest.approx(np.var(seen), rel=1e-3)


def test_frozen_moments_stay():
    learner, rng = fresh(), np.random.default_rng(0)
    played = rollout(learner, rng, a_sign(rng) + 3, lambda _, action: action)
    after, _ = _update(learner, played, jax.random.key(0), settings=SETTINGS)
    assert bitwise_equal(after.policy.normaliser, learner.policy.normaliser)
    assert bitwise_equal(after.critic_normaliser, learner.critic_normaliser)

"""Adversaries on a toy task: what they are paid for, what they remember, what λ makes of them."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.compute.run.checkpoint import load_tree, save_tree
from rigid.learning import adversary as adversaries
from rigid.learning.adversary import (
    Experience,
    pace_at,
    shaped_reward,
    start_adversary,
    train_iteration,
)
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.group_play import Opponent, canonical_motion, group_actor, phase_rng
from rigid.learning.ppo import PPOSettings
from rigid.learning.rollout import play, policy_actor
from rigid.naturalness.gan import remember
from rigid.naturalness.lsgan import PENALTIES, DiscriminatorSettings, score
from rigid.policies.gaussian import GaussianPolicy
from tests.learning.reach import bitwise_equal, goer
from tests.toys import Follower, ToyReach, untrained

TASK = ToyReach()
HUMAN = goer(1)
EPISODES = 32
SETTINGS = AdversarySettings(
    iterations=30,
    episodes=EPISODES,
    ppo=PPOSettings(
        learning_rate=1e-2, minibatch=160, epochs=4, update_normaliser=False, signal_floor=0.1
    ),
    discriminator=DiscriminatorSettings(
        hidden=(16,), learning_rate=3e-3, steps=20, minibatch=128, replay_iterations=3
    ),
)
INF = float("inf")


@pytest.fixture(scope="module")
def canonical():
    """Episodes of the synthetic human with the robot."""
    rng = np.random.default_rng(0)
    human = policy_actor(GaussianPolicy(HUMAN), 40, rng)
    robot = policy_actor(Follower(), 40, None)
    return play(TASK, TASK.make_world(40), np.arange(40), robot, human)


@pytest.fixture(scope="module")
def opponent(canonical):
    return Opponent(
        robot=Follower(),
        human=HUMAN,
        canonical=canonical.features.swapaxes(0, 1),
        canonical_seeds=np.arange(40),
        reward_std=float(canonical.reward.std()),
    )


def start(opponent, *lambdas):
    keys = jax.random.split(jax.random.key(0), len(lambdas))
    return [
        start_adversary(opponent, SETTINGS, lambda_, key)
        for lambda_, key in zip(lambdas, keys, strict=True)
    ]


def train(opponent, group, iterations, seed=0):
    """The group, and what every iteration saw of each member."""
    world, history = TASK.make_world(len(group) * EPISODES), []
    for _ in range(iterations):
        results = train_iteration(TASK, world, group, opponent, SETTINGS, seed)
        group = [member for member, _ in results]
        history.append([metrics for _, metrics in results])
    return group, history


@pytest.fixture(scope="module")
def extremes(opponent):
    """Histories of λ = 0 from scratch and of λ = ∞ from the human."""
    group, history = train(opponent, start(opponent, 0.0, INF), SETTINGS.iterations)
    return group, list(zip(*history, strict=True))


def experience(weight=None):
    """One iteration's rows, made up, with the given weights."""
    rng = np.random.default_rng(0)
    shape = (TASK.horizon, EPISODES)
    weight = np.ones(shape) if weight is None else weight
    made = (
        rng.standard_normal((*shape, 3)),
        rng.standard_normal((*shape, 1)),
        rng.standard_normal(shape),
        weight,
        rng.standard_normal((*shape, 2)),
    )
    return Experience(*(jnp.asarray(rows, jnp.float32) for rows in made))


def update(opponent, adversary, rows):
    key = jax.random.key(0)
    return adversaries._update(adversary, rows, canonical_motion(opponent), key, settings=SETTINGS)


@pytest.mark.parametrize(
    ("lambda_", "expected"),
    [
        pytest.param(0.0, -2.0, id="only the task"),
        pytest.param(3.0, (-2.0 - 3 * 5.0) / 4, id="both"),
        pytest.param(INF, -5.0, id="only naturalness"),
    ],
)
def test_the_reward_by_hand(lambda_, expected):
    """Task reward 2 and penalty 5; both are costs to an adversary."""
    reward, penalty = jnp.full((1, 1), 2.0), jnp.full((1, 1), 5.0)
    found = shaped_reward(jnp.asarray(lambda_), reward, penalty)
    assert found[0, 0] == pytest.approx(0.1 * expected)


def test_a_penalty_weighs_more_the_larger_lambda_is():
    reward, penalty = jnp.zeros((1, 4)), jnp.ones((1, 4))
    paid = [
        shaped_reward(jnp.asarray(x), reward, penalty)[0, 0] for x in (0.0, 0.1, 1.0, 10.0, INF)
    ]
    assert paid == sorted(paid, reverse=True)
    assert (paid[0], paid[-1]) == pytest.approx((0.0, -0.1))


def test_the_pace_rises_for_three_iterations_and_ends_at_0():
    paces = [float(pace_at(i, 30)) for i in (0, 1, 3, 15, 30)]
    assert paces == pytest.approx([0.0, 1 / 3 * 29 / 30, 0.9, 0.5, 0.0])


def test_no_two_phases_or_iterations_share_numbers():
    phases = ("train", "referee", "score", "canonical")
    draws = [
        phase_rng(seed, phase, number).integers(2**63)
        for seed, phase, number in product((0, 1, 2**32 - 1), phases, range(50))
    ]
    assert len(set(draws)) == len(draws)


@pytest.mark.parametrize(
    ("lambda_", "natural"), [(0.0, False), (0.09, False), (0.1, True), (INF, True)]
)
def test_only_large_lambdas_start_at_the_human(opponent, lambda_, natural):
    policy = start(opponent, lambda_)[0].learner.policy
    assert bitwise_equal(policy.network, HUMAN.network) is natural
    assert bitwise_equal(policy.log_std, HUMAN.log_std)
    assert bitwise_equal(policy.normaliser, HUMAN.normaliser)


def test_the_penaltys_unit_is_its_deviation_on_canonical_motion_before_training(opponent):
    fresh = start(opponent, 1.0)[0]
    scores = score(fresh.measure.discriminator.network, canonical_motion(opponent))
    assert fresh.penalty_std == pytest.approx(float(PENALTIES["amp"](scores).std()))
    trained, _ = train(opponent, [fresh], 1)
    assert trained[0].penalty_std == fresh.penalty_std


def test_the_replay_is_a_ring(opponent):
    """The first iteration fills it, each later one replaces the oldest rows."""
    replay, held = start(opponent, 0.0)[0].measure.replay, []
    for iteration in range(5):
        rows = jnp.full((7, 2), float(iteration))
        replay = remember(replay, rows, jnp.asarray(iteration), jax.random.key(0), len(replay) // 3)
        blocks = np.asarray(replay)[:, 0].reshape(3, -1)
        assert (blocks == blocks[:, :1]).all()
        held.append(blocks[:, 0].tolist())
    assert held == [[0, 0, 0], [0, 1, 0], [0, 1, 2], [3, 1, 2], [3, 4, 2]]


def test_a_group_acts_block_by_block_with_each_members_noise():
    policies = [untrained(TASK.human, seed=i, std=std).parameters for i, std in enumerate((0.1, 2))]
    seen = np.random.default_rng(0).standard_normal((6, 3)).astype(np.float32)
    action = group_actor(policies, np.random.default_rng(7))(seen)
    noise = np.random.default_rng(7).standard_normal((2, 3, 1), dtype=np.float32)
    for block, (policy, std) in enumerate(zip(policies, (0.1, 2), strict=True)):
        rows = slice(3 * block, 3 * block + 3)
        mean, _ = GaussianPolicy(policy).sample(seen[rows], (), None)
        np.testing.assert_allclose(action[rows], mean + std * noise[block], rtol=1e-4, atol=1e-5)


def test_a_group_with_memory_acts_as_each_policy_with_memory():
    policies = [untrained(TASK.human, seed=i, std=1e-9, memory=3) for i in range(2)]
    act = group_actor([policy.parameters for policy in policies], np.random.default_rng(0))
    rng, states = np.random.default_rng(1), [policy.initial_state(3) for policy in policies]
    for _ in range(4):
        seen = rng.standard_normal((6, 3)).astype(np.float32)
        action = act(seen)
        for block, policy in enumerate(policies):
            rows = slice(3 * block, 3 * block + 3)
            mean, states[block] = policy.sample(seen[rows], states[block], None)
            np.testing.assert_allclose(action[rows], mean, rtol=1e-4, atol=1e-5)


def test_an_adversary_with_memory_starts_as_the_human_and_learns_from_its_past(opponent):
    settings = replace(SETTINGS, memory=2)
    group = [start_adversary(opponent, settings, 1.0, jax.random.key(0))]
    size = TASK.human.observation_size
    past = group[0].learner.policy.network[0]["w"][size:]
    assert past.shape[0] == size
    assert (past == 0).all()
    world = TASK.make_world(EPISODES)
    for _ in range(2):  # The first one teaches the critic alone.
        group = [train_iteration(TASK, world, group, opponent, settings, 0)[0][0]]
    assert (group[0].learner.policy.network[0]["w"][size:] != 0).any()


def test_lambda_0_from_scratch_learns_to_harm(extremes):
    """The robot follows the hand: a still one returns -10, one at the other goal about -17."""
    _, (attack, _) = extremes
    assert attack[0].mean_return > -12
    assert attack[-1].mean_return < -14
    assert attack[-1].success == 0


def test_lambda_0_is_not_held_back_by_its_discriminator(extremes):
    _, (attack, _) = extremes
    assert attack[-1].naturalness_own < 0.5


def test_lambda_inf_from_the_human_stays_natural_and_harmless(extremes, canonical):
    _, (_, tame) = extremes
    assert np.mean([metrics.naturalness_own for metrics in tame[5:]]) > 0.9
    assert tame[-1].mean_return == pytest.approx(canonical.returns.mean(), abs=0.5)
    assert tame[-1].success > 0.8


def test_both_keep_the_humans_noise_and_scale(extremes):
    group, _ = extremes
    for member in group:
        assert bitwise_equal(member.learner.policy.log_std, HUMAN.log_std)
        assert bitwise_equal(member.learner.policy.normaliser, HUMAN.normaliser)


def test_the_first_iteration_teaches_critic_and_discriminator_only(opponent):
    before = start(opponent, 1.0)
    (after,), _ = train(opponent, before, 1)
    assert bitwise_equal(after.learner.policy, before[0].learner.policy)
    assert not bitwise_equal(after.learner.critic, before[0].learner.critic)
    assert not bitwise_equal(after.measure.discriminator, before[0].measure.discriminator)
    assert after.iteration == 1


def test_another_companion_changes_nothing(opponent):
    """Members share worlds and noise by their place alone, and learn on their own rows."""
    one, tame, wild = start(opponent, 0.1, INF, 0.0)
    (with_tame, _), seen_tame = train(opponent, [one, tame], 2)
    (with_wild, _), seen_wild = train(opponent, [one, wild], 2)
    assert bitwise_equal(with_tame, with_wild)
    assert bitwise_equal(seen_tame[-1][0], seen_wild[-1][0])


def test_stopping_and_going_on_changes_nothing(opponent, tmp_path):
    whole, _ = train(opponent, start(opponent, 0.0, 1.0), 4)
    half, _ = train(opponent, start(opponent, 0.0, 1.0), 2)
    save_tree(tmp_path / "half", half)
    resumed, _ = train(opponent, load_tree(tmp_path / "half", half), 2)
    assert bitwise_equal(resumed, whole)


def test_another_seed_plays_other_episodes(opponent):
    group = start(opponent, 1.0)
    one, other = (train(opponent, group, 1, seed=seed)[0] for seed in (0, 1))
    assert not bitwise_equal(one, other)


def test_what_follows_a_fault_moves_nothing(opponent):
    adversary = start(opponent, 1.0)[0]._replace(iteration=jnp.asarray(5, jnp.int32))
    weight = np.ones((TASK.horizon, EPISODES))
    weight[4:, ::3] = 0.0
    rows = experience(weight)
    lost = rows.weight == 0
    ruined = rows._replace(
        action=jnp.where(lost[..., None], 9.0, rows.action),
        reward=jnp.where(lost, 1e9, rows.reward),
        features=jnp.where(lost[..., None], 1e3, rows.features),
    )
    assert bitwise_equal(update(opponent, adversary, rows), update(opponent, adversary, ruined))


def test_with_nothing_to_gain_the_policy_rests(opponent):
    """Advantages are standardised, so without the floor noise would drive it at full pace."""
    adversary = start(opponent, 0.0)[0]._replace(iteration=jnp.asarray(5, jnp.int32))
    before, steps = adversary.learner.policy.network[0]["w"], {}
    for size in (0.0, 10.0):
        rows = experience()
        after, _ = update(opponent, adversary, rows._replace(reward=size * rows.reward))
        steps[size] = np.abs(after.learner.policy.network[0]["w"] - before).max()
    assert steps[0.0] < 0.3 * steps[10.0]


def test_lambda_0_is_blind_to_features_and_lambda_inf_to_reward(opponent):
    rows = experience()
    louder = rows._replace(reward=rows.reward[::-1])
    stranger = rows._replace(features=rows.features[::-1] + 3)
    policies = {}
    for lambda_ in (0.0, INF):
        adversary = start(opponent, lambda_)[0]._replace(iteration=jnp.asarray(5, jnp.int32))
        policies[lambda_] = [
            update(opponent, adversary, seen)[0].learner for seen in (rows, louder, stranger)
        ]
    base, louder_, stranger_ = policies[0.0]
    assert bitwise_equal(base, stranger_)
    assert not bitwise_equal(base, louder_)
    base, louder_, stranger_ = policies[INF]
    assert bitwise_equal(base, louder_)
    assert not bitwise_equal(base, stranger_)


def test_one_compilation_serves_every_lambda_and_iteration(opponent, tmp_path):
    group, _ = train(opponent, start(opponent, 1.0), 1)
    compiled = adversaries._update._cache_size()
    save_tree(tmp_path / "one", group)
    train(opponent, load_tree(tmp_path / "one", group), 1)
    train(opponent, start(opponent, 0.0, INF), 1)
    assert adversaries._update._cache_size() == compiled

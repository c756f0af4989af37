"""Every search measure on the toy task: what it pulls towards, and that nothing else changes."""

from __future__ import annotations

from dataclasses import replace

import jax
import numpy as np
import pytest

from rigid.compute.run.checkpoint import load_tree, save_tree
from rigid.learning.adversary import own_scores, start_adversary, train_iteration
from rigid.learning.group_play import Opponent
from rigid.learning.rollout import play, policy_actor
from rigid.naturalness.choice import MEASURES
from rigid.policies.gaussian import GaussianPolicy
from tests.learning.reach import bitwise_equal
from tests.learning.test_adversary import EPISODES, HUMAN, INF, SETTINGS, TASK
from tests.toys import Follower

ITERATIONS = 14
OTHERS = ("kl", "mmd", "temporal", "ensemble")  # `lsgan` has tests of its own.


@pytest.fixture(scope="module")
def canonical():
    rng = np.random.default_rng(0)
    human = policy_actor(GaussianPolicy(HUMAN), 40, rng)
    return play(TASK, TASK.make_world(40), np.arange(40), policy_actor(Follower(), 40, None), human)


@pytest.fixture(scope="module")
def opponent(canonical):
    features, std = canonical.features.swapaxes(0, 1), float(canonical.reward.std())
    return Opponent(Follower(), HUMAN, features, np.arange(40), std)


def group_of(opponent, measure, lambdas):
    """Adversaries of which all but λ = ∞ start from random weights."""
    settings = replace(SETTINGS, measure=measure, natural_start=1e6)
    keys = jax.random.split(jax.random.key(0), len(lambdas))
    return settings, [
        start_adversary(opponent, settings, lambda_, key)
        for lambda_, key in zip(lambdas, keys, strict=True)
    ]


def train(opponent, settings, group, iterations):
    world, history = TASK.make_world(len(group) * EPISODES), []
    for _ in range(iterations):
        results = train_iteration(TASK, world, group, opponent, settings, 0)
        group = [adversary for adversary, _ in results]
        history.append([metrics for _, metrics in results])
    return group, history


@pytest.fixture(scope="module", params=OTHERS)
def trained(request, opponent):
    """Name, settings, members for λ = 0, 100 and ∞, and what every iteration saw of them."""
    settings, group = group_of(opponent, request.param, (0.0, 100.0, INF))
    return request.param, settings, *train(opponent, settings, group, ITERATIONS)


@pytest.fixture(scope="module")
def lsgan(opponent):
    settings, group = group_of(opponent, "lsgan", (0.0, 100.0, INF))
    return train(opponent, settings, group, ITERATIONS)[0]


def test_a_measure_pulls_a_stranger_towards_canonical_motion(trained, canonical):
    """The robot follows the hand: a still one returns -10, the natural one about -3."""
    *_, history = trained
    returns = [metrics.mean_return for _, metrics, _ in history]
    assert returns[0] < -9
    assert returns[-1] > -7.5
    assert canonical.returns.mean() > -4


def test_lambda_inf_stays_natural_under_every_measure(trained, canonical):
    *_, history = trained
    assert history[-1][2].mean_return == pytest.approx(canonical.returns.mean(), abs=0.5)


def test_swapping_the_measure_changes_nothing_for_lambda_0(trained, lsgan):
    """It ignores the measure, and no measure draws random numbers that anything else uses."""
    _, _, group, _ = trained
    for ours, theirs in zip(
        jax.tree.leaves(group[0].learner), jax.tree.leaves(lsgan[0].learner), strict=True
    ):
        np.testing.assert_allclose(ours, theirs, rtol=1e-3, atol=1e-5)


def test_own_scores_are_those_of_a_classifier_and_none_without_one(trained, opponent, canonical):
    name, settings, group, history = trained
    features = canonical.features.swapaxes(0, 1)
    scores = own_scores(group[2], features, opponent, settings)
    assert (scores is None) == (name in {"kl", "mmd"}) == np.isnan(history[0][0].naturalness_own)
    if scores is not None:
        assert scores.shape == features.shape[:2]


def test_stopping_and_going_on_changes_nothing_under_any_measure(trained, opponent, tmp_path):
    _, settings, group, _ = trained
    whole, _ = train(opponent, settings, group, 2)
    half, _ = train(opponent, settings, group, 1)
    save_tree(tmp_path / "half", half)
    resumed, _ = train(opponent, settings, load_tree(tmp_path / "half", half), 1)
    assert bitwise_equal(resumed, whole)


def test_paper_d2_is_lsgan_with_another_penalty(opponent):
    settings, (named,) = group_of(opponent, "paper_d2", (1.0,))
    other = replace(settings, measure="lsgan", penalty="paper_d2")
    by_hand = start_adversary(opponent, other, 1.0, jax.random.split(jax.random.key(0), 1)[0])
    assert settings.search_measure == other.search_measure
    assert bitwise_equal(named, by_hand)


def test_measures_are_those_of_the_contract():
    assert {"lsgan", "paper_d2", "kl", "mmd", "temporal", "ensemble"} <= set(MEASURES)

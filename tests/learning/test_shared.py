"""Adversaries of one network: they find known optima for every λ at once, and are resumable."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.compute.run.checkpoint import load_tree, save_tree
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.conditioned import Sharing
from rigid.learning.group_play import Opponent, play_group
from rigid.learning.ppo import PPOSettings
from rigid.learning.ranges import ranges_of
from rigid.learning.rollout import play, policy_actor
from rigid.learning.shared import family_iteration, members, start_family
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.policies.gaussian import GaussianPolicy, mean_action
from rigid.policies.loading import load_policy
from rigid.tasks.analytic.mean_shift import kl_shift
from rigid.tasks.analytic.offset_catch import REACH as REACH_OF_CATCH
from rigid.tasks.analytic.offset_catch import OffsetCatch
from tests.learned_measures import WITH_SLOW
from tests.learning.reach import bitwise_equal
from tests.learning.test_adversary import HUMAN, INF
from tests.learning.test_adversary import SETTINGS as ALONE
from tests.learning.test_adversary import TASK as REACH
from tests.toys import Follower

CATCH = OffsetCatch()
EPISODES = 1000
SETTINGS = AdversarySettings(
    iterations=60,
    episodes=EPISODES,
    sharing=Sharing(
        wild_slots=2, natural_slots=8, natural_from=0.5, natural_average=0.2, retreat=0.0
    ),
    measure="kl",
    ppo=PPOSettings(learning_rate=4e-3, update_normaliser=False, gae_lambda=1.0),
    discriminator=DiscriminatorSettings(hidden=(16,), steps=10, minibatch=128),
)
FEW = Sharing(wild_slots=2, natural_slots=3, retreat=0.0)
LAMBDAS = (0.5, 0.7, 1.0, 1.4, 2.0)


def opponent_of(task, robot, human):
    """Frozen players and 40 canonical episodes, rewards in raw units."""
    rng = np.random.default_rng(0)
    played = play(
        task, task.make_world(40), np.arange(40), policy_actor(robot, 40, None),
        policy_actor(GaussianPolicy(human), 40, rng),
    )  # fmt: skip
    return Opponent(robot, human, played.features.swapaxes(0, 1), np.arange(40), 1.0)


@pytest.fixture(scope="module")
def catch():
    human = load_policy("builtin:synthetic-human", task=CATCH, agent="human")
    robot = load_policy("builtin:catcher", task=CATCH, agent="robot")
    return opponent_of(CATCH, robot, human.parameters)


@pytest.fixture(scope="module")
def reach():
    return opponent_of(REACH, Follower(), HUMAN)


def train(task, opponent, settings, lambdas, iterations, *, families=None, seed=0):
    ranges = ranges_of(lambdas, settings.sharing)
    families = families or [
        start_family(opponent, settings, each, key)
        for each, key in zip(ranges, jax.random.split(jax.random.key(seed), 2), strict=False)
    ]
    world = task.make_world(sum(each.slots for each in ranges) * settings.episodes)
    seen = {}
    for _ in range(iterations):
        families, seen = family_iteration(task, world, families, ranges, opponent, settings, seed)
    return families, ranges, seen


@pytest.fixture(scope="module")
def at_rest(catch):
    """What the last iteration saw, and the offset of each adversary in the end."""
    families, ranges, seen = train(CATCH, catch, SETTINGS, LAMBDAS, SETTINGS.iterations)
    found = members(families, ranges, catch, SETTINGS)
    return seen, [offset_of(found[lambda_].learner.policy) for lambda_ in LAMBDAS]


def offset_of(policy):
    """Mean offset [canonical deviations]."""
    return float(mean_action(policy, jnp.zeros((1, 1)))[0, 0]) * REACH_OF_CATCH


def test_one_network_finds_the_optimum_of_every_lambda(at_rest):
    """Under λ KL the canonical offset shifts by 1 / λ: fourfold over these λ."""
    exact = [kl_shift(lambda_) for lambda_ in LAMBDAS]
    np.testing.assert_allclose(at_rest[1], exact, rtol=0.1)


def test_each_lambda_reports_the_slot_that_played_it(at_rest):
    """Returns are minus the offset, so that the harm falls as λ rises."""
    returns = [at_rest[0][lambda_].mean_return for lambda_ in LAMBDAS]
    assert returns == sorted(returns)


def test_the_wild_family_starts_from_random_weights_and_the_natural_one_at_the_human(reach):
    settings = replace(ALONE, sharing=FEW)
    wild, natural = (
        start_family(reach, settings, each, jax.random.key(0)).learner.policy
        for each in ranges_of((0.0, INF), FEW)
    )
    np.testing.assert_array_equal(natural.network[0]["w"][:3], HUMAN.network[0]["w"])
    assert np.abs(wild.network[0]["w"][:3] - HUMAN.network[0]["w"]).max() > 0.1


def test_a_lambda_that_both_families_train_at_is_served_by_the_one_it_belongs_to(reach):
    """0.1 is wild, and the natural family trains at it for the sake of others."""
    settings = replace(ALONE, sharing=FEW, episodes=8)
    families, ranges, seen = train(REACH, reach, settings, (0.1, 1.0), 1)
    found = members(families, ranges, reach, settings)
    assert set(found) == set(seen) == {0.1, 1.0}
    np.testing.assert_array_equal(
        found[0.1].learner.policy.network[1]["w"], families[0].learner.policy.network[1]["w"]
    )


def test_an_adversary_is_the_moving_average_of_the_natural_network_and_the_last_wild_one(reach):
    """Over half of four iterations: what was before an iteration counts half as much after it."""
    settings = replace(ALONE, sharing=replace(FEW, natural_average=0.5), episodes=8, iterations=4)
    families, networks = None, []
    for _ in range(3):
        families, ranges, _ = train(REACH, reach, settings, (0.0, 1.0), 1, families=families)
        networks.append([family.learner.policy.network[1]["w"] for family in families])
    found = members(families, ranges, reach, settings)
    wild, natural = (found[lambda_].learner.policy.network[1]["w"] for lambda_ in (0.0, 1.0))
    np.testing.assert_array_equal(wild, networks[-1][0])
    expected = HUMAN.network[1]["w"]
    for _, network in networks:
        expected = (expected + network) / 2
    np.testing.assert_allclose(natural, expected, rtol=1e-5)
    assert np.abs(natural - networks[-1][1]).max() > 1e-3


def test_an_adversary_of_lambda_1_or_more_goes_part_of_the_way_back_to_the_human(reach):
    """What a network adds to the human's is kept to the share that is not gone back."""
    settings = replace(ALONE, sharing=FEW, episodes=8)
    families, ranges, _ = train(REACH, reach, settings, (0.0, 0.9, 1.0, INF), 1)
    returning = replace(settings, sharing=replace(FEW, retreat=0.25))
    away = members(families, ranges, reach, settings)
    back = members(families, ranges, reach, returning)
    for lambda_ in (0.0, 0.9):
        assert bitwise_equal(back[lambda_], away[lambda_])
    for lambda_ in (1.0, INF):
        learned, kept = (found[lambda_].learner.policy.network for found in (away, back))
        expected = jax.tree.map(lambda near, far: (near + 3 * far) / 4, HUMAN.network, learned)
        jax.tree.map(partial(np.testing.assert_allclose, rtol=1e-5, atol=1e-7), kept, expected)


@pytest.mark.parametrize("measure", WITH_SLOW)
def test_stopping_and_going_on_changes_nothing_under_any_measure(reach, measure, tmp_path):
    settings = replace(ALONE, sharing=FEW, measure=measure, episodes=8)
    lambdas = (0.0, 0.5, 2.0)
    whole, *_ = train(REACH, reach, settings, lambdas, 2)
    half, *_ = train(REACH, reach, settings, lambdas, 1)
    save_tree(tmp_path / "half", half)
    loaded = load_tree(tmp_path / "half", half)
    resumed, *_ = train(REACH, reach, settings, lambdas, 1, families=loaded)
    assert bitwise_equal(resumed, whole)


def test_an_adversary_is_a_policy_without_a_code_that_remembers_as_settings_say(reach):
    settings = replace(ALONE, sharing=FEW, memory=3, episodes=8)
    families, ranges, _ = train(REACH, reach, settings, (0.0, 1.0, 2.0), 1)
    for adversary in members(families, ranges, reach, settings).values():
        assert adversary.learner.policy.network[0]["w"].shape[0] == 3 * REACH.human.observation_size


def test_the_wild_family_explores_loudly_and_rests_at_the_noise_of_the_human(reach, monkeypatch):
    """Played with three times the noise at first, with the human's from 60 % on; stored: always."""
    played = []

    def listen(task, world, policies, *others):
        played.append([float(each.log_std[0] - HUMAN.log_std[0]) for each in policies])
        return play_group(task, world, policies, *others)

    monkeypatch.setattr("rigid.learning.shared.play_group", listen)
    settings = replace(ALONE, sharing=FEW, episodes=8, iterations=5)
    families, ranges, _ = train(REACH, reach, settings, (0.0, 1.0), 4)
    factors = np.exp(played)
    np.testing.assert_allclose(factors[:, 0], [3, 3 ** (2 / 3), 3 ** (1 / 3), 1], rtol=1e-5)
    np.testing.assert_array_equal(factors[:, 2:], 1.0)
    for adversary in members(families, ranges, reach, settings).values():
        np.testing.assert_array_equal(adversary.learner.policy.log_std, HUMAN.log_std)

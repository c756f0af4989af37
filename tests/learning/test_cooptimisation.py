"""Co-optimisation on a toy task: the pair gets better, and may stop and go on."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.learning import cooptimisation
from rigid.learning.cooptimisation import CoOptimisationSettings, co_optimise, noise_at, start_team
from rigid.learning.ppo import PPOSettings
from rigid.learning.rollout import play, policy_actor
from rigid.policies.gaussian import GaussianPolicy
from tests.learning.reach import OpenReach, bitwise_equal
from tests.toys import Pointer

TASK = OpenReach()
SETTINGS = CoOptimisationSettings(
    iterations=25,
    episodes=48,
    hidden=(16,),
    ppo=PPOSettings(learning_rate=5e-3, minibatch=120, epochs=4),
)
STOP = 3


@pytest.fixture(scope="module")
def trained():
    """The last pair, and after every iteration: progress, pair, updates compiled so far."""
    history = []

    def report(progress, pair):
        history.append((progress, pair, cooptimisation._update._cache_size()))

    final = co_optimise(TASK, SETTINGS, seed=0, report=report)
    return final, *zip(*history, strict=True)


def test_a_pair_learns_to_help(trained):
    """Doing nothing returns -10, the best pair about -2."""
    _, progress, *_ = trained
    assert progress[0].mean_return < -8
    assert progress[-1].mean_return > -5
    assert progress[-1].success > progress[0].success


def test_progress_is_reported_after_every_iteration(trained):
    final, progress, pairs, _ = trained
    assert [seen.iteration for seen in progress] == list(range(SETTINGS.iterations))
    assert [seen.noise for seen in progress] == [
        noise_at(SETTINGS, i) for i in range(SETTINGS.iterations)
    ]
    assert bitwise_equal(final, pairs[-1])


def test_stopping_and_going_on_changes_nothing(trained):
    final, _, pairs, _ = trained
    behind = SETTINGS.iterations - STOP
    assert bitwise_equal(
        co_optimise(TASK, SETTINGS, seed=0, start=(pairs[behind - 1], behind)), final
    )


def test_another_seed_is_another_pair():
    one, other = (start_team(TASK, SETTINGS, seed) for seed in (0, 1))
    assert not bitwise_equal(one, other)
    assert not bitwise_equal(one.robot.policy.network, one.humans[0].policy.network)


def test_the_noise_that_stays_is_the_last_one(trained):
    final, *_ = trained
    for learner in (final.robot, *final.humans):
        np.testing.assert_allclose(np.exp(learner.policy.log_std), SETTINGS.std[1], rtol=1e-5)


def test_noise_falls_to_its_last_value_and_stays():
    settings = CoOptimisationSettings(iterations=100, std=(0.8, 0.2), anneal=0.5)
    levels = [noise_at(settings, i) for i in (0, 25, 50, 75, 99)]
    assert levels == pytest.approx([0.8, 0.4, 0.2, 0.2, 0.2])


def test_critics_see_what_both_see():
    pair = start_team(TASK, SETTINGS, 0)
    seen = TASK.robot.observation_size + TASK.human.observation_size
    for learner in (pair.robot, *pair.humans):
        assert learner.critic_normaliser.mean.shape == (seen,)


def test_every_iteration_uses_the_same_compiled_update(trained):
    *_, compiled = trained
    assert len(set(compiled)) == 1


def test_a_robot_learns_with_a_human_who_learns_no_more():
    """The grown-up points with the hand; the robot of the team serves a human it never changed."""
    start = start_team(TASK, SETTINGS, 0), 0
    team = co_optimise(TASK, SETTINGS, seed=0, start=start, grown_up=[Pointer()])
    seeds, rng = np.arange(100), np.random.default_rng(0)
    robot = policy_actor(GaussianPolicy(team.robot.policy), 100, None)
    episodes = play(TASK, TASK.make_world(100), seeds, robot, policy_actor(Pointer(), 100, rng))
    assert episodes.returns.mean() > -5


def test_every_human_of_a_team_learns_from_its_own_episodes():
    settings = CoOptimisationSettings(iterations=1, episodes=12, hidden=(4,), ppo=SETTINGS.ppo)
    start = start_team(TASK, settings, 0, humans=2)
    one, other = co_optimise(TASK, settings, seed=0, start=(start, 0)).humans
    for before, after in zip(start.humans, (one, other), strict=True):
        assert after.critic_normaliser.count == pytest.approx(6 * TASK.horizon, rel=1e-3)
        assert not bitwise_equal(before.policy.network, after.policy.network)
    assert not bitwise_equal(one.policy.network, other.policy.network)

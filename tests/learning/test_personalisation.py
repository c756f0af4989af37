"""Personalisation on a toy task whose goal must be read from the hand's motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import jax
import numpy as np
import pytest

from rigid.learning import personalisation
from rigid.learning.personalisation import (
    Partner,
    PersonalisationSettings,
    continue_robot,
    noise_at,
    personalise,
    start_robot,
)
from rigid.learning.ppo import PPOSettings
from rigid.learning.rollout import play, policy_actor
from rigid.policies.gaussian import GaussianPolicy
from rigid.tasks.protocol import AgentSpec
from tests.learning.reach import OpenReach, bitwise_equal, goer
from tests.toys import Pointer, ToyReach

TASK, PRIVILEGED = ToyReach(), OpenReach()
EXPERT = GaussianPolicy(goer(0))
PARTNERS = [Partner(Pointer(), EXPERT)]
SETTINGS = PersonalisationSettings(
    iterations=25,
    episodes=48,
    hidden=(16,),
    ppo=PPOSettings(
        learning_rate=1e-2,
        minibatch=120,
        epochs=4,
        cloning_coefficient=1.0,
        policy_coefficient=0.1,
    ),
)
STOP = 3


@dataclass
class Constant:
    """Always the same action."""

    action: float
    observation_size: int = 3
    action_size: int = 1

    def initial_state(self, batch):
        del batch
        return ()

    def act(self, observation, state, rng):
        del rng
        return np.full((len(observation), 1), self.action), state


@pytest.fixture(scope="module")
def trained():
    """The robot, and after every iteration: learner, updates compiled so far."""
    history = []

    def report(_, learner):
        history.append((learner, personalisation._update._cache_size()))

    robot = personalise(
        TASK,
        PRIVILEGED,
        PARTNERS,
        SETTINGS,
        seed=0,
        report=report,
    )
    return robot, *zip(*history, strict=True)


def mean_return(task, robot):
    seeds, rng = np.arange(200), np.random.default_rng(0)
    actors = policy_actor(robot, 200, None), policy_actor(Pointer(), 200, rng)
    return play(task, task.make_world(200), seeds, *actors).returns.mean()


def test_the_student_nearly_returns_what_the_expert_does(trained):
    """The expert starts at once; the student must first see the hand move. Blind: -10."""
    expert = mean_return(PRIVILEGED, EXPERT)
    student = mean_return(TASK, GaussianPolicy(trained[0].policy))
    assert expert > -2.5
    assert expert - 2.0 < student < expert


def test_the_student_does_not_see_what_is_hidden(trained):
    """Its network takes robot and hand; before the hand moves it cannot tell the goals apart."""
    student = GaussianPolicy(trained[0].policy)
    assert student.observation_size == TASK.robot.observation_size == 2
    assert PRIVILEGED.robot.observation_size == 3


def test_the_rollout_hides_the_goal_from_the_student_alone():
    learner = start_robot(TASK, PRIVILEGED, SETTINGS, 0)
    world, rng = PRIVILEGED.make_world(SETTINGS.episodes), np.random.default_rng(0)
    episodes = personalisation._play(
        PRIVILEGED, world, learner, PARTNERS, settings=SETTINGS, rng=rng
    )
    rollout = personalisation._rollout(episodes, learner, PARTNERS, TASK.robot, SETTINGS)
    seen, goal = episodes.robot_observation, episodes.features[..., 1]
    np.testing.assert_array_equal(rollout.observation, seen[..., :2])
    np.testing.assert_array_equal(rollout.critic_observation[..., 2], goal)
    clipped = np.clip(EXPERT.act(seen.reshape(-1, 3), (), None)[0], -1, 1)
    np.testing.assert_allclose(rollout.expert_action.reshape(-1, 1), clipped, atol=1e-6)


def test_stopping_and_going_on_changes_nothing(trained):
    robot, learners, _ = trained
    behind = SETTINGS.iterations - STOP
    resumed = personalise(
        TASK,
        PRIVILEGED,
        PARTNERS,
        SETTINGS,
        seed=0,
        start=(learners[behind - 1], behind),
    )
    assert bitwise_equal(resumed, robot)


def test_every_iteration_uses_the_same_compiled_update(trained):
    *_, compiled = trained
    assert len(set(compiled)) == 1


def test_humans_share_the_episodes_evenly():
    learner = start_robot(TASK, PRIVILEGED, SETTINGS, 0)
    partners = [Partner(Constant(action), EXPERT) for action in (-1.0, 0.0, 1.0)]
    world, rng = PRIVILEGED.make_world(SETTINGS.episodes), np.random.default_rng(0)
    episodes = personalisation._play(
        PRIVILEGED, world, learner, partners, settings=SETTINGS, rng=rng
    )
    np.testing.assert_array_equal(
        episodes.human_action[..., 0], np.tile(np.repeat([-1, 0, 1], 16), (TASK.horizon, 1))
    )


def test_noise_falls_geometrically_from_the_first_to_the_last_iteration():
    settings = PersonalisationSettings(iterations=3, std=(0.4, 0.1))
    assert [noise_at(settings, i) for i in range(3)] == pytest.approx([0.4, 0.2, 0.1])


def test_another_seed_is_another_robot():
    one, other = (start_robot(TASK, PRIVILEGED, SETTINGS, seed) for seed in (0, 1))
    assert not bitwise_equal(one, other)
    assert jax.tree.structure(one) == jax.tree.structure(other)


def test_episodes_are_split_by_shares():
    learner = start_robot(TASK, PRIVILEGED, SETTINGS, 0)
    partners = [Partner(Constant(-1.0), EXPERT, 0.75), Partner(Constant(1.0), None, 0.25)]
    world, rng = PRIVILEGED.make_world(SETTINGS.episodes), np.random.default_rng(0)
    episodes = personalisation._play(
        PRIVILEGED, world, learner, partners, settings=SETTINGS, rng=rng
    )
    assert (episodes.human_action[..., 0] == 1).sum(axis=1).tolist() == [12] * TASK.horizon


def test_without_an_expert_cloning_asks_for_what_the_student_does():
    learner = start_robot(TASK, PRIVILEGED, SETTINGS, 0)
    partners = [Partner(Pointer(), EXPERT), Partner(Pointer(), None)]
    world, rng = PRIVILEGED.make_world(SETTINGS.episodes), np.random.default_rng(0)
    episodes = personalisation._play(
        PRIVILEGED, world, learner, partners, settings=SETTINGS, rng=rng
    )
    rollout = personalisation._rollout(episodes, learner, partners, TASK.robot, SETTINGS)
    seen = episodes.robot_observation[:, 24:, :2].reshape(-1, 2)
    own, _ = GaussianPolicy(learner.policy).act(seen, (), None)
    np.testing.assert_allclose(rollout.expert_action[:, 24:].reshape(-1, 1), own, atol=1e-6)


def test_scores_of_choices_are_cloned_as_they_are_and_reals_as_the_task_takes_them():
    seen = np.linspace(-50, 50, 3 * EXPERT.observation_size, dtype=np.float32)
    seen = seen.reshape(1, 3, EXPERT.observation_size)
    choosing = AgentSpec(EXPERT.observation_size, 1, choices=(1,))
    scores = personalisation._advice(EXPERT, seen, choosing)
    assert abs(scores).max() > 1
    reals = personalisation._advice(EXPERT, seen, TASK.robot)
    np.testing.assert_array_equal(reals, np.clip(scores, -1, 1))


def test_reward_alone_teaches_a_robot_whose_human_nobody_knows():
    """This human points away from the goal, so that the robot must learn to go against the hand."""
    settings = replace(SETTINGS, ppo=replace(SETTINGS.ppo, policy_coefficient=1.0))
    liar = Pointer(honest=False)
    learner = personalise(TASK, PRIVILEGED, [Partner(liar, None)], settings, seed=0)
    seeds, rng = np.arange(100), np.random.default_rng(0)
    robot = policy_actor(GaussianPolicy(learner.policy), 100, None)
    returns = play(TASK, TASK.make_world(100), seeds, robot, policy_actor(liar, 100, rng)).returns
    assert returns.mean() > -8  # Doing nothing returns -10, following the hand less.


def test_a_robot_that_goes_on_acts_as_before_with_a_new_critic():
    robot = GaussianPolicy(start_robot(TASK, PRIVILEGED, SETTINGS, 0).policy)
    learner = continue_robot(TASK, PRIVILEGED, SETTINGS, robot, 1)
    assert bitwise_equal(learner.policy, robot.parameters)
    assert bitwise_equal(learner.critic, start_robot(TASK, PRIVILEGED, SETTINGS, 1).critic)

"""Every learner is handed the weights of what was played, so that a fault teaches nobody."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.learning import best_response, cooptimisation
from rigid.learning.personalisation import rollout_of
from rigid.learning.rollout import play, policy_actor
from rigid.policies.gaussian import GaussianPolicy
from rigid.tasks.protocol import AgentSpec
from tests.learning.reach import OpenReach, goer
from tests.toys import Follower, Pointer


@pytest.fixture(scope="module")
def episodes():
    """Six episodes, of which every third seed runs away half-way."""
    task, rng = OpenReach(fault_every=3), np.random.default_rng(0)
    pointer = policy_actor(Pointer(), 6, rng)
    played = play(
        task, task.make_world(6), np.arange(6), policy_actor(Follower(), 6, None), pointer
    )
    assert 0 < played.faulted.sum() < 6
    return played


def rollout_of_a_team(episodes):
    seen, done = episodes.robot_observation, episodes.robot_action
    return cooptimisation._rollout(episodes, seen, done, slice(None), 1.0)


def rollout_of_a_personalised_robot(episodes):
    seen, expert = episodes.robot_observation[..., :2], GaussianPolicy(goer(0))
    return rollout_of(episodes, seen, [expert], [slice(0, 6)], AgentSpec(2, 1), 1.0)


def rollout_of_a_response(episodes):
    return best_response._rollout(episodes, episodes.robot_action, 1.0)


@pytest.mark.parametrize(
    "rollout", [rollout_of_a_team, rollout_of_a_personalised_robot, rollout_of_a_response]
)
def test_a_learner_is_handed_the_weights_of_the_episodes(rollout, episodes):
    np.testing.assert_array_equal(rollout(episodes).weight, episodes.weight)


def test_a_human_of_a_team_is_handed_those_of_its_own_episodes(episodes):
    seen, done = episodes.human_observation, episodes.human_action
    rollout = cooptimisation._rollout(episodes, seen, done, slice(2, 5), 1.0)
    np.testing.assert_array_equal(rollout.weight, episodes.weight[:, 2:5])

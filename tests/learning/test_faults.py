"""Every learner is handed the weights of what was played, so that a fault teaches nobody."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.learning import best_response, cooptimisation, personalisation
from rigid.learning.personalisation import PersonalisationSettings
from rigid.learning.rollout import play, policy_actor
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


def rollouts_of_a_pair(episodes):
    return cooptimisation._rollouts(episodes, 1.0)


def rollouts_of_a_personalised_robot(episodes):
    return (personalisation._rollout(episodes, goer(0), 2, PersonalisationSettings()),)


def rollouts_of_a_response(episodes):
    return (best_response._rollout(episodes, episodes.robot_action, 1.0),)


@pytest.mark.parametrize(
    "rollouts", [rollouts_of_a_pair, rollouts_of_a_personalised_robot, rollouts_of_a_response]
)
def test_a_learner_is_handed_the_weights_of_the_episodes(rollouts, episodes):
    for rollout in rollouts(episodes):
        np.testing.assert_array_equal(rollout.weight, episodes.weight)

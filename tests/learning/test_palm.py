"""PALM on a toy task whose goal must be read from the hand's motion."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.learning.motion_vae import MotionSettings
from rigid.learning.palm import (
    Companion,
    PalmSettings,
    held_out_prediction,
    personalise_palm,
    policy_of,
    start_palm,
)
from rigid.learning.personalisation import Partner, PersonalisationSettings
from rigid.learning.ppo import PPOSettings
from rigid.learning.rollout import play, policy_actor
from rigid.policies.gaussian import GaussianPolicy
from tests.learning.reach import ShownReach, bitwise_equal, goer
from tests.toys import Pointer

TASK = ShownReach()
EXPERT = GaussianPolicy(goer(0))
COMPANIONS = [
    Companion(Partner(Pointer(), EXPERT, 3.0), TASK.seeing_the_itch()),
    Companion(Partner(Pointer(), EXPERT, 1.0), TASK.diversified().seeing_the_itch()),
]
SETTINGS = PalmSettings(
    personalisation=PersonalisationSettings(
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
    ),
    motion=MotionSettings(hidden=8, latent=2, learning_rate=1e-2, minibatch=120),
)
STOP = 3


@pytest.fixture(scope="module")
def trained():
    """The robot, and the learner after every iteration."""
    history = []
    robot = personalise_palm(
        TASK, COMPANIONS, SETTINGS, seed=0, report=lambda _, learner: history.append(learner)
    )
    return robot, history


def test_the_robot_helps_a_human_whose_goal_it_cannot_see(trained):
    """Blind: -10; who sees the goal: -2."""
    seeds, rng = np.arange(200), np.random.default_rng(0)
    robot = policy_actor(policy_of(trained[0], SETTINGS), 200, None)
    found = play(TASK, TASK.make_world(200), seeds, robot, policy_actor(Pointer(), 200, rng))
    assert found.returns.mean() > -5


def test_it_predicts_held_out_motion_better_than_constant_velocity(trained):
    """The hand stops at the goal."""
    found = held_out_prediction(
        [TASK, TASK.diversified()], [one.partner for one in COMPANIONS], trained[0], SETTINGS,
        episodes=40, seed=0,
    )  # fmt: skip
    assert 0 < found.palm < found.constant_velocity


def test_stopping_and_going_on_changes_nothing(trained):
    robot, history = trained
    behind = SETTINGS.personalisation.iterations - STOP
    start = history[behind - 1], behind
    assert bitwise_equal(personalise_palm(TASK, COMPANIONS, SETTINGS, seed=0, start=start), robot)


def test_encoder_and_decoder_learn_beside_the_policy(trained):
    fresh, robot = start_palm(TASK, COMPANIONS[0].task, SETTINGS, 0), trained[0]
    for part in ("encoder", "decoder", "log_variance", "displacement"):
        assert not bitwise_equal(getattr(fresh.vae, part), getattr(robot.vae, part))


def test_the_robot_sees_neither_goal_nor_human_observation(trained):
    policy = policy_of(trained[0], SETTINGS)
    assert policy.observation_size == TASK.robot.observation_size == 2
    assert policy.parameters.head.network[0]["w"].shape[0] == 2 + SETTINGS.motion.latent


def test_a_partner_without_an_expert_is_refused():
    alone = [Companion(Partner(Pointer(), None), TASK.seeing_the_itch())]
    with pytest.raises(ValueError, match="every partner of PALM needs an expert"):
        personalise_palm(TASK, alone, SETTINGS, seed=0)

"""Responses on a toy task of known answer: what can be read from a human, and what cannot."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.compute.evaluation import evaluate
from rigid.learning.best_response import ResponseSettings, best_response
from rigid.learning.ppo import PPOSettings
from rigid.policies.passive import PassivePolicy
from rigid.tasks.views.everything import SeeingEverything
from tests.toys import Follower, Pointer, ToyReach

TASK = ToyReach()
SETTINGS = ResponseSettings(
    iterations=60,
    imitation=8,
    episodes=48,
    hidden=(32,),
    std=(1.0, 0.2),
    ppo=PPOSettings(learning_rate=1e-2, minibatch=240),
)
LIAR = Pointer(honest=False)
"""Moves the hand to the goal that is none."""
STILL = PassivePolicy(3, 1)
"""Shows nothing of the goal."""


def success_of(view, human, seed=0):
    response = best_response(view, human, Follower(), SETTINGS, seed=seed)
    return evaluate(view, response, human, episodes=100, seed=1)["success"]


def test_a_liar_defeats_the_robot_that_believes():
    assert evaluate(TASK, Follower(), LIAR, episodes=100, seed=1)["success"] == 0.0


def test_a_response_reads_a_liar_the_other_way_round():
    assert success_of(TASK, LIAR) >= 0.9


def test_what_nobody_shows_only_a_robot_that_sees_everything_knows():
    blind, seeing = success_of(TASK, STILL), success_of(SeeingEverything(TASK), STILL)
    assert blind <= 0.7
    assert seeing >= 0.9


def test_a_response_first_imitates_the_robot_that_failed():
    returns = []
    settings = ResponseSettings(
        iterations=SETTINGS.imitation, imitation=SETTINGS.imitation, episodes=48, hidden=(32,),
        std=(0.1, 0.1), ppo=SETTINGS.ppo,
    )  # fmt: skip
    best_response(
        TASK, LIAR, Follower(), settings, seed=0, report=lambda p: returns.append(p.mean_return)
    )
    believed = evaluate(TASK, Follower(), LIAR, episodes=100, seed=1)["return"]
    assert returns[0] == pytest.approx(-10, abs=2)  # It stands still.
    assert returns[-1] == pytest.approx(believed, abs=1)


def test_the_same_seed_gives_the_same_response():
    settings = ResponseSettings(iterations=2, imitation=1, episodes=4, hidden=(4,))
    seen = np.array([[0.1, 0.2]], np.float32)
    one, other = (
        best_response(TASK, LIAR, Follower(), settings, seed=3).act(seen, (), None)[0]
        for _ in range(2)
    )
    np.testing.assert_array_equal(one, other)

"""Episodes: what a row means, who acts where, and what a fault does to the weights."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.learning.rollout import play, policy_actor
from tests.toys import SPEED, Follower, Pointer, ToyReach, untrained

TASK = ToyReach()
SEEDS = np.array([3, 8, 3])


def episodes(task=TASK, seeds=SEEDS, human=None, **options):
    human = human or policy_actor(Pointer(), len(seeds), None)
    robot = policy_actor(Follower(), len(seeds), None)
    return play(task, task.make_world(len(seeds)), seeds, robot, human, **options)


def test_a_row_is_what_was_seen_what_was_done_and_what_came_of_it():
    played = episodes()
    hand, goal = played.features[..., 0], played.features[..., 1]
    before = played.human_observation[..., 1]
    np.testing.assert_array_equal(before[0], 0.0)
    np.testing.assert_allclose(before[1:], hand[:-1])
    np.testing.assert_allclose(hand - before, SPEED * played.human_action[..., 0], atol=1e-6)
    robot = played.robot_observation[1:, :, 0]  # After the step before.
    np.testing.assert_allclose(played.reward[:-1], -np.abs(robot - goal[:-1]), atol=1e-6)


def test_equal_seeds_start_alike():
    played = episodes()
    np.testing.assert_array_equal(played.human_observation[:, 0], played.human_observation[:, 2])


def test_returns_are_sums_over_steps_and_everything_is_float32():
    played = episodes()
    assert played.returns == pytest.approx(played.reward.sum(axis=0))
    assert played.reward.shape == (TASK.horizon, 3)
    assert {array.dtype for array in played[:-1]} == {np.dtype(np.float32)}


def test_a_fault_weighs_nothing_from_its_step_on():
    task = ToyReach(horizon=6, fault_every=4)  # Seed 8 runs away in step 3 of 6.
    played = episodes(task)
    np.testing.assert_array_equal(played.weight[:, 1], [1, 1, 0, 0, 0, 0])
    np.testing.assert_array_equal(played.weight[:, 0], np.ones(6))
    np.testing.assert_array_equal(played.faulted, [0, 1, 0])


def test_a_watcher_sees_the_reset_and_every_step():
    seen = []
    played = episodes(watch=lambda number, step: seen.append((number, step.reward)))
    assert [number for number, _ in seen] == list(range(TASK.horizon + 1))
    np.testing.assert_array_equal(seen[0][1], 0.0)
    np.testing.assert_allclose([reward for _, reward in seen[1:]], played.reward, rtol=1e-6)


def test_an_actor_carries_its_policys_state():
    policy, rng = untrained(TASK.human, memory=3), np.random.default_rng(0)
    actor, state = policy_actor(policy, 2, None), policy.initial_state(2)
    for _ in range(4):
        observation = rng.standard_normal((2, 3)).astype(np.float32)
        expected, state = policy.act(observation, state, None)
        np.testing.assert_array_equal(actor(observation), expected)

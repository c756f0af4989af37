"""Joined worlds are their parts, row for row."""

from __future__ import annotations

import numpy as np

from rigid.learning.rollout import play, policy_actor
from rigid.tasks.protocol import World
from rigid.tasks.views.joined import JoinedWorlds
from tests.toys import Follower, Pointer, ToyReach

TASK, SLOW = ToyReach(), ToyReach(fault_every=2)
SEEDS = np.arange(5)


def played(world, seeds):
    actors = (policy_actor(policy, len(seeds), None) for policy in (Follower(), Pointer()))
    return play(TASK, world, seeds, *actors)


def test_episodes_are_those_of_the_parts():
    joined = JoinedWorlds([TASK.make_world(2), SLOW.make_world(3)])
    assert isinstance(joined, World)
    assert joined.batch == 5
    together = played(joined, SEEDS)
    parts = played(TASK.make_world(2), SEEDS[:2]), played(SLOW.make_world(3), SEEDS[2:])
    for name in ("robot_observation", "human_observation", "reward", "features", "weight"):
        alone = np.concatenate([getattr(part, name) for part in parts], axis=1)
        np.testing.assert_array_equal(getattr(together, name), alone)
    alone = np.concatenate([part.summary.success for part in parts])
    np.testing.assert_array_equal(together.summary.success, alone)
    assert together.faulted.tolist() == [0, 0, 1, 0, 1]


def test_what_a_step_tells_besides_is_joined():
    joined = JoinedWorlds([TASK.make_world(2), SLOW.make_world(3)])
    assert joined.reset(SEEDS).info["distance"].shape == (5,)
    assert joined.snapshot().shape == (5, 0)

"""Evaluating a pair: return, success, outcomes and forces over fresh episodes."""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.compute.endings import Ended, ended, measure
from rigid.learning.rollout import play, policy_actor
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task

BLOCK = 100
"""Episodes played side by side."""


def evaluate(
    task: Task, robot: Policy, human: Policy, *, episodes: int, seed: int
) -> dict[str, Any]:
    """Plays `episodes` episodes and measures them; None is unknown.

    The robot acts by its mean, the human samples, as in every measurement. Block b of 100 draws
    starts and noise from (`seed`, b) alone; what a last block plays too much is dropped.

    Raises:
        ValueError: `episodes` or `seed` is out of range.
    """
    for name, value, least in (("episodes", episodes, 1), ("seed", seed, 0)):
        if value < least:
            raise ValueError(f"{name} must be at least {least}, got {value}")
    world = task.make_world(min(BLOCK, episodes))
    blocks: list[Ended] = []
    for number in range(-(-episodes // world.batch)):
        rng = np.random.default_rng([seed, number])
        starts = rng.integers(2**31, size=world.batch)
        actors = policy_actor(robot, world.batch, None), policy_actor(human, world.batch, rng)
        blocks.append(ended(play(task, world, starts, *actors)))
    everything = Ended(*(np.concatenate(columns) for columns in zip(*blocks, strict=True)))
    return measure(everything, slice(episodes), task, task.return_range)

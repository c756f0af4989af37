"""Trainings on the toy task that take a moment, and what is asked of every recipe."""

from __future__ import annotations

from dataclasses import replace

import jax
import numpy as np

from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.personalisation import PersonalisationSettings
from rigid.learning.ppo import PPOSettings
from rigid.policies.native import load_native
from rigid.robots.pair import train_pair
from tests.toys import ToyReach

ITERATIONS = 14
PPO = PPOSettings(epochs=2, minibatch=40)
PAIR = CoOptimisationSettings(iterations=ITERATIONS, episodes=8, hidden=(6,), ppo=PPO)
VANILLA = PersonalisationSettings(
    iterations=ITERATIONS, episodes=8, hidden=(6, 6), memory=2,
    ppo=replace(PPO, cloning_coefficient=1.0, policy_coefficient=0.1),
)  # fmt: skip


class Seen:
    """Remembers the iterations it was told of, and interrupts after one of them."""

    def __init__(self, last=None):
        self.iterations, self._last = [], last
        self.begun = None

    def begin(self, task, episodes, done):
        self.begun = (task.horizon, episodes, done)

    def watch(self, task):
        return task

    def __call__(self, progress):
        self.iterations.append(progress.iteration)
        if progress.iteration == self._last:
            raise KeyboardInterrupt


def co_optimise(out, report=None, settings=PAIR, seed=0, task=None):
    """Trains a toy pair."""
    train_pair(task or ToyReach(), settings, seed=seed, out=out, report=report or Seen())
    return out


def names(directory):
    """Every file below a directory."""
    return {str(path.relative_to(directory)) for path in directory.rglob("*") if path.is_file()}


def same(one, other):
    """Whether two policy directories hold the same weights."""
    mine, theirs = (load_native(path).policy.parameters for path in (one, other))
    return all(jax.tree.leaves(jax.tree.map(np.array_equal, mine, theirs)))


def kinship(one, other):
    """Correlation of all weights of two policies; of strangers with as few as here up to 0.6."""
    mine, theirs = (load_native(path).policy.parameters.network for path in (one, other))
    flat = [np.concatenate([np.ravel(layer["w"]) for layer in each]) for each in (mine, theirs)]
    return np.corrcoef(*flat)[0, 1]

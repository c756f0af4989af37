"""`ToyReach` for learning: hand-made experts, and the task with the goal open to the robot."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np

from rigid.policies.gaussian import GaussianParameters
from rigid.policies.networks import init_mlp, init_normaliser
from rigid.tasks.protocol import AgentSpec
from tests.toys import SPEED, ToyReach, ToyWorld


class OpenReach(ToyReach):
    """The robot sees the goal as well, as its last number."""

    def __init__(self, **parameters):
        super().__init__(**parameters)
        self.robot = AgentSpec(3, 1, ("robot", "hand", "goal"))

    def make_world(self, batch, *, threads=0):
        del threads
        return OpenWorld(self, batch)


class ShownReach(ToyReach):
    """Says that the hand shows the human; `varied`, the goal may lie anywhere between -1 and 1."""

    shown_human = ("hand",)

    def __init__(self, *, seeing=False, varied=False, **parameters):
        super().__init__(**parameters)
        self.seeing, self.varied = seeing, varied
        if seeing:
            self.robot = AgentSpec(3, 1, ("robot", "hand", "goal"))

    def diversified(self):
        return ShownReach(seeing=self.seeing, varied=True)

    def seeing_the_itch(self):
        return ShownReach(seeing=True, varied=self.varied)

    def make_world(self, batch, *, threads=0):
        del threads
        world = (OpenWorld if self.seeing else ToyWorld)(self, batch)
        return VariedWorld(world) if self.varied else world

    def describe(self):
        return {**super().describe(), "varied": self.varied}


class VariedWorld:
    """Worlds whose goals are drawn anywhere between -1 and 1."""

    def __init__(self, world):
        self._world, self.batch = world, world.batch
        self.step, self.summary, self.snapshot = world.step, world.summary, world.snapshot

    def reset(self, seeds):
        self._world.reset(seeds)
        share = [np.random.default_rng([7, int(seed)]).uniform() for seed in seeds]
        self._world._goal *= share
        return self._world._look(np.zeros(self.batch))


class OpenWorld(ToyWorld):
    """B episodes of `OpenReach`."""

    def _look(self, reward):
        step = super()._look(reward)
        goal = step.features[:, 1:]
        return step._replace(robot_observation=np.concatenate([step.robot_observation, goal], 1))


def goer(point: int, *, std=0.2, hidden=16) -> GaussianParameters:
    """Moves what it sees at place `point` to the goal, which it sees last, at full speed.

    Its first hidden unit does the work; the others are there to learn with.
    """
    network = init_mlp(jax.random.key(0), (3, hidden, 1))
    gaze = jnp.zeros(3).at[point].set(-1.0).at[2].set(1.0)
    first = network[0]["w"].at[:, 0].set(0.5 * gaze)
    last = jnp.zeros((hidden, 1)).at[0, 0].set(2 / SPEED)
    network = [network[0] | {"w": first}, network[1] | {"w": last}]
    return GaussianParameters(network, jnp.full(1, np.log(std), jnp.float32), init_normaliser(3))


def bitwise_equal(one, other) -> bool:
    """Whether two pytrees hold the same numbers to the last bit."""
    return jax.tree.structure(one) == jax.tree.structure(other) and all(
        np.asarray(a).tobytes() == np.asarray(b).tobytes()
        for a, b in zip(jax.tree.leaves(one), jax.tree.leaves(other), strict=True)
    )

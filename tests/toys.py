"""A small task and policies for it: real parts of the protocol, instant, with known answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from rigid.policies.gaussian import GaussianParameters, GaussianPolicy
from rigid.policies.networks import init_normaliser
from rigid.policies.palm import MotionEncoder, PalmParameters, PalmPolicy
from rigid.tasks.protocol import AgentSpec, Step, Summary

SPEED = 0.2
"""Distance that a full action covers in a step."""
CLOSE = 0.1
"""The robot has helped when it ends nearer to the goal than this."""


class ToyReach:
    """Robot and hand are points on a line, both at 0; only the human knows the goal, +1 or -1.

    An action moves its point by `SPEED` at most. Reward: minus the distance between robot and goal
    after the step. A robot that follows the hand gets all there is. Episodes whose seed is a
    multiple of `fault_every` run away half-way; 0 for none.
    """

    feature_names = ("hand", "goal")
    outcome_names = ("helped", "unhelped")

    def __init__(
        self,
        *,
        horizon: int = 10,
        fault_every: int = 0,
        name: str = "toy-reach",
        return_range: tuple[float, float] | None = (-20.0, 0.0),
    ):
        self.horizon, self.fault_every, self.name = horizon, fault_every, name
        self.return_range = return_range
        self.robot = AgentSpec(2, 1, ("robot", "hand"))
        self.human = AgentSpec(3, 1, ("robot", "hand", "goal"))

    def make_world(self, batch: int, *, threads: int = 0) -> ToyWorld:
        del threads
        return ToyWorld(self, batch)

    def features(self, step: Step) -> np.ndarray:
        return step.features

    def scene(self) -> None:
        return None

    def replay(self, snapshots: np.ndarray) -> Mapping[str, Any]:
        del snapshots
        return {}

    def describe(self) -> Mapping[str, Any]:
        parameters = {"horizon": self.horizon, "fault_every": self.fault_every}
        return {"name": self.name, "version": 0, "parameters": parameters}


class ToyWorld:
    """B episodes of `ToyReach`."""

    def __init__(self, task: ToyReach, batch: int):
        self.batch, self._task = batch, task
        self._begin(np.zeros(batch, dtype=np.int64))

    def _begin(self, seeds: np.ndarray) -> None:
        self._robot, self._hand = np.zeros(self.batch), np.zeros(self.batch)
        self._goal = np.array([np.random.default_rng(seed).choice([-1.0, 1.0]) for seed in seeds])
        every = self._task.fault_every
        self._faulty = seeds % every == 0 if every else np.zeros(self.batch, dtype=bool)
        self._time = 0

    def reset(self, seeds: np.ndarray) -> Step:
        self._begin(seeds)
        return self._look(np.zeros(self.batch))

    def step(self, robot_action: np.ndarray, human_action: np.ndarray) -> Step:
        self._robot += SPEED * np.clip(robot_action[:, 0], -1, 1)
        self._hand += SPEED * np.clip(human_action[:, 0], -1, 1)
        self._time += 1
        return self._look(-self._distance())

    def summary(self) -> Summary:
        success = (self._distance() < CLOSE).astype(np.float64)
        nothing = np.zeros(self.batch)
        return Summary(success, (1 - success).astype(np.int64), nothing, nothing, {})

    def snapshot(self) -> np.ndarray:
        return np.zeros((self.batch, 0))

    def _distance(self) -> np.ndarray:
        return np.abs(self._robot - self._goal)

    def _look(self, reward: np.ndarray) -> Step:
        features = np.stack([self._hand, self._goal], axis=1).astype(np.float32)
        robot = np.stack([self._robot, self._hand], axis=1).astype(np.float32)
        faulted = self._faulty & (2 * self._time >= self._task.horizon)
        seen = np.concatenate([robot, features[:, 1:]], axis=1)
        return Step(robot, seen, reward, features, faulted, {"distance": self._distance()})


@dataclass
class Follower:
    """The robot that helps: goes to where the hand is."""

    observation_size: int = 2
    action_size: int = 1

    def initial_state(self, batch):
        del batch
        return ()

    def act(self, observation, state, rng):
        del rng
        ahead = (observation[:, 1:] - observation[:, :1]) / SPEED
        return np.clip(ahead, -1.0, 1.0), state


@dataclass
class Pointer:
    """The natural human: moves the hand to the goal (to the other one when `honest` is false)."""

    honest: bool = True
    noise: float = 0.1
    observation_size: int = 3
    action_size: int = 1

    def initial_state(self, batch):
        del batch
        return ()

    def act(self, observation, state, rng):
        goal = observation[:, 2:] if self.honest else -observation[:, 2:]
        action = (goal - observation[:, 1:2]) / SPEED
        if rng is not None:
            action = action + self.noise * rng.standard_normal(action.shape)
        return np.clip(action, -1.0, 1.0), state


def untrained(spec: AgentSpec, *, seed=0, memory=1, hidden=(8, 4), std=0.5) -> GaussianPolicy:
    """A random Gaussian policy of the right size, made without compiling anything."""
    rng = np.random.default_rng(seed)
    sizes = (spec.observation_size * memory, *hidden, spec.action_size)
    network = [
        {
            "w": _float32(rng.standard_normal(size) / size[0] ** 0.5),
            "b": _float32(np.zeros(size[1])),
        }
        for size in pairwise(sizes)
    ]
    log_std = _float32(np.full(spec.action_size, np.log(std)))
    parameters = GaussianParameters(network, log_std, init_normaliser(sizes[0]))
    return GaussianPolicy(parameters, memory=memory)


def untrained_palm(spec: AgentSpec, *, seed=0, memory=4, hidden=(8, 4), latent=2) -> PalmPolicy:
    """A random PALM policy of the right size, made without compiling anything."""
    rng = np.random.default_rng([seed, 1])
    size, width = spec.observation_size, 5
    shapes = {"w": (2 * size, 3 * width), "u": (width, 3 * width), "b": (3 * width,)}
    unit = {name: _float32(rng.standard_normal(shape)) for name, shape in shapes.items()}
    mean = {
        "w": _float32(rng.standard_normal((width, latent))),
        "b": _float32(rng.standard_normal(latent)),
    }
    encoder = MotionEncoder(unit, mean, init_normaliser(size), init_normaliser(size))
    head = untrained(AgentSpec(size + latent, spec.action_size), seed=seed, hidden=hidden)
    return PalmPolicy(PalmParameters(encoder, head.parameters), memory=memory)


def _float32(values: np.ndarray) -> jax.Array:
    return jnp.asarray(values, jnp.float32)

"""Co-optimisation: human and robot learn together to help (paper, appendix B; Clegg et al., 2020).

The robot may see what is hidden from it later (in itch scratching the itch). The human of the pair
becomes the synthetic human; the robot becomes the expert from which the personalized robot is
cloned.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from rigid.learning.learner import Learner, Rollout, with_noise
from rigid.learning.ppo import PPOSettings, init_learner, ppo_update
from rigid.learning.rollout import Actor, Trajectories, play
from rigid.policies.gaussian import GaussianPolicy
from rigid.tasks.protocol import AgentSpec, Task, World


@dataclass(frozen=True, kw_only=True)
class CoOptimisationSettings:
    """Size and length of co-optimisation."""

    iterations: int = 160
    """Ours: the paper takes 400; the pair's return is flat from about 120 on (3.1 M steps)."""
    episodes: int = 192
    """Episodes of one iteration: 19,200 steps (paper)."""
    hidden: tuple[int, ...] = (100, 100)
    """Assistive Gym's networks."""
    std: tuple[float, float] = (0.5, 0.2)
    """Action noise at the start and from `anneal` of the training on, in units of a full action;
    the last one stays the synthetic human's noise. Ours."""
    anneal: float = 0.9
    """Share of the training over which the noise falls. Ours."""
    reward_scale: float = 0.1
    """Keeps the critic's targets near 1. Ours."""
    ppo: PPOSettings = field(default_factory=PPOSettings)


class Pair(NamedTuple):
    """Robot and human in training."""

    robot: Learner
    human: Learner


class Progress(NamedTuple):
    """What one iteration of training saw."""

    iteration: int
    mean_return: float
    success: float
    noise: float


_update = jax.jit(ppo_update, static_argnames="settings")


def start_pair(task: Task, settings: CoOptimisationSettings, seed: int) -> Pair:
    """Two random learners; their critics see what both agents see."""
    seen = task.robot.observation_size + task.human.observation_size
    keys = jax.random.split(jax.random.key(seed))

    def learner(key: jax.Array, agent: AgentSpec) -> Learner:
        return init_learner(
            key,
            settings.ppo,
            observation_size=agent.observation_size,
            critic_observation_size=seen,
            action_size=agent.action_size,
            hidden=settings.hidden,
            std=settings.std[0],
        )

    return Pair(learner(keys[0], task.robot), learner(keys[1], task.human))


def co_optimise(
    task: Task,
    settings: CoOptimisationSettings,
    *,
    seed: int,
    start: tuple[Pair, int] | None = None,
    report: Callable[[Progress, Pair], None] = lambda *_: None,
) -> Pair:
    """Trains a pair; randomness comes from (`seed`, iteration), so it can stop and go on.

    Args:
        task: The task as the pair sees it.
        settings: Budget.
        seed: Everything random comes from it.
        start: A pair and the number of iterations that it has behind it.
        report: Called after every iteration with the pair as it then is.
    """
    pair, done = start or (start_pair(task, settings, seed), 0)
    world = task.make_world(settings.episodes)
    for iteration in range(done, settings.iterations):
        noise = noise_at(settings, iteration)
        pair = Pair(*(with_noise(learner, noise) for learner in pair))
        episodes = _play_pair(task, world, pair, np.random.default_rng([seed, iteration]))
        keys = jax.random.split(jax.random.fold_in(jax.random.key(seed), iteration))
        rollouts = _rollouts(episodes, settings.reward_scale)
        updates = [
            _update(learner, rollout, key, settings=settings.ppo)[0]
            for learner, rollout, key in zip(pair, rollouts, keys, strict=True)
        ]
        pair = Pair(*updates)
        success = float(np.mean(episodes.summary.success))
        report(Progress(iteration, float(episodes.returns.mean()), success, noise), pair)
    return pair


def noise_at(settings: CoOptimisationSettings, iteration: int) -> float:
    """Action noise of an iteration: geometric from the first to the last value, then constant.

    Example:
        >>> settings = CoOptimisationSettings(iterations=10, std=(0.8, 0.2), anneal=1.0)
        >>> [round(noise_at(settings, i), 2) for i in (0, 5, 10)]
        [0.8, 0.4, 0.2]
    """
    first, last = settings.std
    share = min(iteration / (settings.anneal * settings.iterations), 1.0)
    return float(first * (last / first) ** share)


def _play_pair(task: Task, world: World, pair: Pair, rng: np.random.Generator) -> Trajectories:
    seeds = rng.integers(2**31, size=world.batch)

    def actor(learner: Learner) -> Actor:
        policy = GaussianPolicy(learner.policy)
        return lambda observation: policy.sample(observation, (), rng)[0]

    return play(task, world, seeds, actor(pair.robot), actor(pair.human))


def _rollouts(episodes: Trajectories, scale: float) -> tuple[Rollout, Rollout]:
    both = np.concatenate([episodes.robot_observation, episodes.human_observation], axis=-1)

    def rollout(observation: np.ndarray, action: np.ndarray) -> Rollout:
        return Rollout(
            observation=jnp.asarray(observation),
            critic_observation=jnp.asarray(both),
            action=jnp.asarray(action),
            reward=jnp.asarray(episodes.reward * scale),
            weight=jnp.asarray(episodes.weight),
            expert_action=jnp.zeros_like(action),
        )

    return (
        rollout(episodes.robot_observation, episodes.robot_action),
        rollout(episodes.human_observation, episodes.human_action),
    )

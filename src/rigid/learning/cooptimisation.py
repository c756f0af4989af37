"""Co-optimisation: human and robot learn together to help (paper, appendix B; Clegg et al., 2020).

The robot may see what is hidden from it later (in itch scratching the itch). The human of a pair
becomes the synthetic human; the robot becomes the expert from which the personalized robot is
cloned. A robot may also learn with several humans at once (Czempin & Gleave, 2022), some of whom
may have learned before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from rigid.learning.learner import Learner, Rollout, with_noise
from rigid.learning.ppo import PPOSettings, init_learner, ppo_update
from rigid.learning.rollout import (
    Actor,
    Trajectories,
    blocks_of,
    play,
    policy_actor,
    side_by_side,
)
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.protocol import Policy
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


class Team(NamedTuple):
    """A robot and the humans that learn with it; one human makes a pair."""

    robot: Learner
    humans: tuple[Learner, ...]


class Progress(NamedTuple):
    """What one iteration of training saw."""

    iteration: int
    mean_return: float
    success: float
    noise: float


_update = jax.jit(ppo_update, static_argnames="settings")


def start_team(task: Task, settings: CoOptimisationSettings, seed: int, *, humans: int = 1) -> Team:
    """Random learners; their critics see what both agents see."""
    seen = task.robot.observation_size + task.human.observation_size
    keys = jax.random.split(jax.random.key(seed), 1 + humans)

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

    return Team(learner(keys[0], task.robot), tuple(learner(key, task.human) for key in keys[1:]))


def co_optimise(
    task: Task,
    settings: CoOptimisationSettings,
    *,
    seed: int,
    start: tuple[Team, int] | None = None,
    grown_up: Sequence[Policy] = (),
    report: Callable[[Progress, Team], None] = lambda *_: None,
) -> Team:
    """Trains a team; randomness comes from (`seed`, iteration), so it can stop and go on.

    Args:
        task: The task as the team sees it.
        settings: Budget; every iteration splits its episodes evenly among the humans.
        seed: Everything random comes from it.
        start: A team and the number of iterations that it has behind it; a new pair by default.
        grown_up: Humans with whom the robot also plays, and who learn no more.
        report: Called after every iteration with the team as it then is.
    """
    team, done = start or (start_team(task, settings, seed), 0)
    blocks = blocks_of(settings.episodes, [1.0] * (len(grown_up) + len(team.humans)))
    world = task.make_world(settings.episodes)
    for iteration in range(done, settings.iterations):
        noise = noise_at(settings, iteration)
        team = _with_noise(team, noise)
        rng = np.random.default_rng([seed, iteration])
        episodes = _play(task, world, team, grown_up, blocks, rng)
        key = jax.random.fold_in(jax.random.key(seed), iteration)
        team = _updated(team, episodes, blocks[len(grown_up) :], key, settings)
        success = float(np.mean(episodes.summary.success))
        report(Progress(iteration, float(episodes.returns.mean()), success, noise), team)
    return team


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


def _with_noise(team: Team, noise: float) -> Team:
    humans = tuple(with_noise(human, noise) for human in team.humans)
    return Team(with_noise(team.robot, noise), humans)


def _play(
    task: Task,
    world: World,
    team: Team,
    grown_up: Sequence[Policy],
    blocks: Sequence[slice],
    rng: np.random.Generator,
) -> Trajectories:
    seeds = rng.integers(2**31, size=world.batch)

    def learning(learner: Learner) -> Actor:
        policy = GaussianPolicy(learner.policy)
        return lambda observation: policy.sample(observation, (), rng)[0]

    known = [
        policy_actor(human, block.stop - block.start, rng)
        for human, block in zip(grown_up, blocks, strict=False)
    ]
    humans = [*known, *(learning(human) for human in team.humans)]
    return play(task, world, seeds, learning(team.robot), side_by_side(humans, blocks))


def _updated(
    team: Team,
    episodes: Trajectories,
    blocks: Sequence[slice],
    key: jax.Array,
    settings: CoOptimisationSettings,
) -> Team:
    """The team after an iteration; each of its humans learns from its own block of episodes."""
    everything = slice(None)
    observations = [episodes.robot_observation, *[episodes.human_observation] * len(blocks)]
    actions = [episodes.robot_action, *[episodes.human_action] * len(blocks)]
    learners = [
        _update(
            learner,
            _rollout(episodes, observation, action, block, settings.reward_scale),
            own_key,
            settings=settings.ppo,
        )[0]
        for learner, observation, action, block, own_key in zip(
            [team.robot, *team.humans], observations, actions, [everything, *blocks],
            jax.random.split(key, 1 + len(blocks)), strict=True,
        )
    ]  # fmt: skip
    return Team(learners[0], tuple(learners[1:]))


def _rollout(
    episodes: Trajectories,
    observation: np.ndarray,
    action: np.ndarray,
    block: slice,
    scale: float,
) -> Rollout:
    both = np.concatenate([episodes.robot_observation, episodes.human_observation], axis=-1)
    return Rollout(
        observation=jnp.asarray(observation[:, block]),
        critic_observation=jnp.asarray(both[:, block]),
        action=jnp.asarray(action[:, block]),
        reward=jnp.asarray(episodes.reward[:, block] * scale),
        weight=jnp.asarray(episodes.weight[:, block]),
        expert_action=jnp.zeros_like(action[:, block]),
    )

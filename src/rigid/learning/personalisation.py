"""The personalized robot: trained to assist one synthetic human, without seeing what is hidden.

The paper's Vanilla RL (appendix 'Learning Robot Policies'): PPO with a behaviour-cloning loss
towards the robot of the co-optimised pair. That expert sees the hidden goal and is asked at every
state the student visits, so the student learns from its own mistakes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import jax
import jax.numpy as jnp
import numpy as np

from rigid.learning.cooptimisation import Progress
from rigid.learning.learner import Learner, Rollout, with_noise
from rigid.learning.ppo import PPOSettings, init_learner, ppo_update
from rigid.learning.rollout import Trajectories, play, policy_actor
from rigid.policies.gaussian import (
    GaussianParameters,
    GaussianPolicy,
    history_windows,
    mean_action,
)
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task, World


@dataclass(frozen=True, kw_only=True)
class PersonalisationSettings:
    """Budget and losses of a personalized robot."""

    iterations: int = 100
    """Ours: the paper takes 240; success is 1 from about 20 on."""
    episodes: int = 96
    """Episodes of one iteration: 9,600 steps (paper)."""
    hidden: tuple[int, ...] = (100, 100, 100, 100)
    """Paper: a 4-layer MLP of width 100."""
    memory: int = 1
    """Observations that the robot sees, newest first."""
    std: tuple[float, float] = (0.2, 0.05)
    """Action noise at the start and at the end of training. Ours; the robot is measured without."""
    reward_scale: float = 0.1
    """Keeps the critic's targets near 1. Ours."""
    ppo: PPOSettings = field(
        default_factory=lambda: PPOSettings(
            learning_rate=3e-4,
            clip=0.3,
            epochs=6,
            minibatch=960,
            cloning_coefficient=1.0,
            policy_coefficient=0.1,
        )
    )
    """Clip and loss weights as in the paper. Ours: learning rate 3e-4 and 6 epochs of 10
    minibatches instead of 5e-5 and 30 of 20, the same progress per step for a fifth of the time;
    gradient norm clipped at 0.5 instead of 20, which never bites."""


_update = jax.jit(ppo_update, static_argnames="settings")
_mean = jax.jit(mean_action)


def start_robot(
    task: Task, privileged: Task, settings: PersonalisationSettings, seed: int
) -> Learner:
    """A random robot; its critic sees the hidden numbers and what the human sees."""
    seen = privileged.robot.observation_size + task.human.observation_size
    return init_learner(
        jax.random.key(seed),
        settings.ppo,
        observation_size=task.robot.observation_size,
        critic_observation_size=seen,
        action_size=task.robot.action_size,
        hidden=settings.hidden,
        std=settings.std[0],
        memory=settings.memory,
    )


def personalise(
    task: Task,
    privileged: Task,
    expert: GaussianParameters,
    humans: Sequence[Policy],
    settings: PersonalisationSettings,
    *,
    seed: int,
    start: tuple[Learner, int] | None = None,
    report: Callable[[Progress, Learner], None] = lambda *_: None,
) -> Learner:
    """Trains a robot for `humans`; the first one is the synthetic human.

    Args:
        task: The task as the robot will meet it.
        privileged: The same task whose robot observation ends in the hidden numbers; the student
            sees the part before them.
        expert: The co-optimised robot, which acts on the privileged observation.
        humans: Every iteration splits its episodes evenly among them.
        settings: Budget and losses.
        seed: Everything random comes from it.
        start: A learner and the number of iterations that it has behind it.
        report: Called after every iteration.
    """
    visible = task.robot.observation_size
    key = jax.random.key(seed)
    learner, done = start or (start_robot(task, privileged, settings, seed), 0)
    world = privileged.make_world(settings.episodes)
    for iteration in range(done, settings.iterations):
        learner = with_noise(learner, noise_at(settings, iteration))
        rng = np.random.default_rng([seed, iteration])
        episodes = _play(privileged, world, learner, humans, settings=settings, rng=rng)
        rollout = _rollout(episodes, expert, visible, settings)
        step_key = jax.random.fold_in(key, iteration)
        learner, _ = _update(learner, rollout, step_key, settings=settings.ppo)
        success = float(np.mean(episodes.summary.success))
        noise = noise_at(settings, iteration)
        report(Progress(iteration, float(episodes.returns.mean()), success, noise), learner)
    return learner


def noise_at(settings: PersonalisationSettings, iteration: int) -> float:
    """Action noise of an iteration, geometric from the first to the last value."""
    first, last = settings.std
    return float(first * (last / first) ** (iteration / max(settings.iterations - 1, 1)))


def _play(
    task: Task,
    world: World,
    learner: Learner,
    humans: Sequence[Policy],
    *,
    settings: PersonalisationSettings,
    rng: np.random.Generator,
) -> Trajectories:
    seeds = rng.integers(2**31, size=settings.episodes)
    student = GaussianPolicy(learner.policy, memory=settings.memory)
    state = student.initial_state(settings.episodes)

    def robot(seen: np.ndarray) -> np.ndarray:
        nonlocal state
        action, state = student.sample(seen[:, : student.observation_size], state, rng)
        return action

    bounds = np.linspace(0, settings.episodes, len(humans) + 1).astype(int).tolist()
    parts = list(pairwise(bounds))
    actors = [
        policy_actor(human, high - low, rng)
        for human, (low, high) in zip(humans, parts, strict=True)
    ]

    def human(observation: np.ndarray) -> np.ndarray:
        rows = [act(observation[low:high]) for act, (low, high) in zip(actors, parts, strict=True)]
        return np.concatenate(rows)

    return play(task, world, seeds, robot, human)


def _rollout(
    episodes: Trajectories,
    expert: GaussianParameters,
    visible: int,
    settings: PersonalisationSettings,
) -> Rollout:
    seen = episodes.robot_observation
    target = np.clip(np.asarray(_mean(expert, seen)), -1, 1)
    both = np.concatenate([seen, episodes.human_observation], axis=-1)
    return Rollout(
        observation=jnp.asarray(history_windows(seen[..., :visible], settings.memory)),
        critic_observation=jnp.asarray(both),
        action=jnp.asarray(episodes.robot_action),
        reward=jnp.asarray(episodes.reward * settings.reward_scale),
        weight=jnp.asarray(episodes.weight),
        expert_action=jnp.asarray(target),
    )

"""The personalized robot: trained to assist one synthetic human, without seeing what is hidden.

The paper's Vanilla RL (appendix 'Learning Robot Policies'): PPO with a behaviour-cloning loss
towards the robot of the co-optimised pair. That expert sees the hidden goal and is asked at every
state the student visits, so the student learns from its own mistakes. With more partners than one
the same training makes the robots of the other recipes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from rigid.learning.cooptimisation import Progress
from rigid.learning.learner import Learner, Rollout, with_noise
from rigid.learning.ppo import PPOSettings, init_learner, ppo_update, start_learner
from rigid.learning.rollout import (
    Student,
    Trajectories,
    blocks_of,
    play,
    policy_actor,
    side_by_side,
    student_actor,
)
from rigid.policies.gaussian import GaussianPolicy, history_windows, mean_action
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import AgentSpec, Task, World


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


@dataclass(frozen=True)
class Partner:
    """A human that a robot learns to assist."""

    human: Policy
    expert: GaussianPolicy | None
    """A robot whose advice is cloned wherever the student goes with this human. It sees the first
    of the numbers that the privileged task shows, as many as it was made for. None: nobody knows
    better, and reward alone teaches."""
    share: float = 1.0
    """Of the episodes, relative to those of the others."""


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


def continue_robot(
    task: Task,
    privileged: Task,
    settings: PersonalisationSettings,
    robot: GaussianPolicy,
    seed: int,
) -> Learner:
    """A learner that acts as `robot`, with a new critic: policies on disk have none."""
    fresh = start_robot(task, privileged, settings, seed)
    return start_learner(settings.ppo, robot.parameters, fresh.critic, fresh.critic_normaliser)


def personalise(
    task: Task,
    privileged: Task,
    partners: Sequence[Partner],
    settings: PersonalisationSettings,
    *,
    seed: int,
    start: tuple[Learner, int] | None = None,
    report: Callable[[Progress, Learner], None] = lambda *_: None,
) -> Learner:
    """Trains a robot for its partners.

    Args:
        task: The task as the robot will meet it.
        privileged: The same task whose robot observation ends in the hidden numbers; the student
            sees the part before them.
        partners: Every iteration splits its episodes among them by their shares.
        settings: Budget and losses.
        seed: Everything random comes from it.
        start: A learner and the number of iterations that it has behind it.
        report: Called after every iteration.

    Raises:
        ValueError: A partner's share is too small for a single episode.
    """
    key = jax.random.key(seed)
    learner, done = start or (start_robot(task, privileged, settings, seed), 0)
    world = privileged.make_world(settings.episodes)
    for iteration in range(done, settings.iterations):
        learner = with_noise(learner, noise_at(settings, iteration))
        rng = np.random.default_rng([seed, iteration])
        episodes = _play(privileged, world, learner, partners, settings=settings, rng=rng)
        rollout = _rollout(episodes, learner, partners, task.robot, settings)
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
    partners: Sequence[Partner],
    *,
    settings: PersonalisationSettings,
    rng: np.random.Generator,
) -> Trajectories:
    student = GaussianPolicy(learner.policy, memory=settings.memory)
    return play_with(task, world, student, partners, rng)


def play_with(
    task: Task,
    world: World,
    student: Student,
    partners: Sequence[Partner],
    rng: np.random.Generator,
) -> Trajectories:
    """Plays an episode in every world, which the partners share in their order."""
    seeds = rng.integers(2**31, size=world.batch)
    robot = student_actor(student, world.batch, rng)
    blocks = _blocks(partners, world.batch)
    actors = [
        policy_actor(partner.human, block.stop - block.start, rng)
        for partner, block in zip(partners, blocks, strict=True)
    ]
    return play(task, world, seeds, robot, side_by_side(actors, blocks))


def _rollout(
    episodes: Trajectories,
    learner: Learner,
    partners: Sequence[Partner],
    spec: AgentSpec,
    settings: PersonalisationSettings,
) -> Rollout:
    seen = episodes.robot_observation
    student = GaussianPolicy(learner.policy, memory=settings.memory)
    # Who has no advice says what the student does itself: cloning then moves nothing by itself.
    advisers = [partner.expert or student for partner in partners]
    windows = history_windows(seen[..., : spec.observation_size], settings.memory)
    blocks = _blocks(partners, seen.shape[1])
    return rollout_of(episodes, windows, advisers, blocks, spec, settings.reward_scale)


def rollout_of(
    episodes: Trajectories,
    observation: Float[np.ndarray, "T N w"],
    advisers: Sequence[GaussianPolicy],
    blocks: Sequence[slice],
    spec: AgentSpec,
    reward_scale: float,
) -> Rollout:
    """What a student learns from.

    Args:
        episodes: As the student played them, seen with the hidden numbers.
        observation: What the student's network was given at every step.
        advisers: One for each block, whose advice is cloned there.
        blocks: Of the episodes, side by side.
        spec: Of the robot; reals are cloned as the task takes them, scores of choices as they are.
        reward_scale: Factor on the reward.
    """
    seen = episodes.robot_observation
    advice = [
        _advice(adviser, seen[:, block], spec)
        for adviser, block in zip(advisers, blocks, strict=True)
    ]
    both = np.concatenate([seen, episodes.human_observation], axis=-1)
    return Rollout(
        observation=jnp.asarray(observation),
        critic_observation=jnp.asarray(both),
        action=jnp.asarray(episodes.robot_action),
        reward=jnp.asarray(episodes.reward * reward_scale),
        weight=jnp.asarray(episodes.weight),
        expert_action=jnp.asarray(np.concatenate(advice, axis=1)),
    )


def _advice(expert: GaussianPolicy, seen: np.ndarray, spec: AgentSpec) -> np.ndarray:
    """What `expert` would do at every step, shape (T, N, a)."""
    windows = history_windows(seen[..., : expert.observation_size], expert.memory)
    mean = np.asarray(_mean(expert.parameters, windows))
    # Scores of choices are compared before anything is clipped, or all beyond 1 would be alike.
    advice: np.ndarray = mean if spec.choices else np.clip(mean, -1, 1)
    return advice


def _blocks(partners: Sequence[Partner], episodes: int) -> list[slice]:
    return blocks_of(episodes, [partner.share for partner in partners])

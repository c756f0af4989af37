"""PALM: a robot that embeds how the human moves, trained with diverse humans.

The paper, appendix 'Learning Robot Policies', after He et al. (2022). Each iteration plays episodes
with every partner, each in its own task, and learns twice from them: PPO with each partner's expert
to be cloned, as for the personalized robot, and the autoencoder that predicts the human's motion.
The policy is given the mean of the latent, through which no gradient of its own flows: that keeps
the latent what prediction makes of it. Ours.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import jax
import numpy as np

from rigid.learning.cooptimisation import Progress
from rigid.learning.learner import Learner, with_noise
from rigid.learning.motion import constant_velocity, motion_of, root_mean_square, shown_columns
from rigid.learning.motion_vae import MotionSettings, MotionVAE, init_vae, predict, update_vae
from rigid.learning.personalisation import (
    Partner,
    PersonalisationSettings,
    noise_at,
    play_with,
    rollout_of,
)
from rigid.learning.ppo import init_learner, ppo_update
from rigid.learning.rollout import Trajectories, blocks_of, play, policy_actor, side_by_side
from rigid.policies.gaussian import history_windows
from rigid.policies.palm import PalmParameters, PalmPolicy, with_latent
from rigid.tasks.protocol import Task
from rigid.tasks.views.joined import JoinedWorlds


@dataclass(frozen=True, kw_only=True)
class PalmSettings:
    """Budget and losses of a PALM robot."""

    personalisation: PersonalisationSettings = field(default_factory=PersonalisationSettings)
    """Of its policy; `memory` is the autoencoder's."""
    motion: MotionSettings = field(default_factory=MotionSettings)


class PalmLearner(NamedTuple):
    """A PALM robot in training."""

    robot: Learner
    """Its policy acts on the newest observation and the latent."""
    vae: MotionVAE


class Companion(NamedTuple):
    """A partner and where it lives."""

    partner: Partner
    task: Task
    """With the hidden numbers, which the partner's expert and the critic see, at the end of the
    robot's observation."""


class Prediction(NamedTuple):
    """Errors on motion that nobody trained on: root mean square of a coordinate, in its units."""

    palm: float
    constant_velocity: float


_update = jax.jit(ppo_update, static_argnames="settings")
_update_vae = jax.jit(update_vae, static_argnames="settings")
_with_latent = jax.jit(with_latent)
_predict = jax.jit(predict)


def start_palm(task: Task, privileged: Task, settings: PalmSettings, seed: int) -> PalmLearner:
    """A random robot; its critic sees the hidden numbers and what the human sees.

    Raises:
        UserError: The task does not say which of the robot's observations show the human.
    """
    training, motion = settings.personalisation, settings.motion
    size, shown = task.robot.observation_size, len(shown_columns(task))
    robot_key, vae_key = jax.random.split(jax.random.key(seed))
    robot = init_learner(
        robot_key,
        training.ppo,
        observation_size=size + motion.latent,
        critic_observation_size=privileged.robot.observation_size + task.human.observation_size,
        action_size=task.robot.action_size,
        hidden=training.hidden,
        std=training.std[0],
    )
    return PalmLearner(robot, init_vae(vae_key, motion, observation_size=size, shown=shown))


def policy_of(learner: PalmLearner, settings: PalmSettings) -> PalmPolicy:
    """The robot as it acts."""
    parameters = PalmParameters(learner.vae.encoder, learner.robot.policy)
    return PalmPolicy(parameters, memory=settings.motion.memory)


def personalise_palm(
    task: Task,
    companions: Sequence[Companion],
    settings: PalmSettings,
    *,
    seed: int,
    start: tuple[PalmLearner, int] | None = None,
    report: Callable[[Progress, PalmLearner], None] = lambda *_: None,
) -> PalmLearner:
    """Trains a robot for its partners, each in its own task.

    Args:
        task: The task as the robot will meet it.
        companions: Every iteration splits its episodes among them by their shares.
        settings: Budget and losses.
        seed: Everything random comes from it.
        start: A learner and the number of iterations that it has behind it.
        report: Called after every iteration.

    Raises:
        UserError: The task does not say which of the robot's observations show the human.
        ValueError: A partner's share is too small for a single episode, or it has no expert.
    """
    training, partners = settings.personalisation, [one.partner for one in companions]
    if any(partner.expert is None for partner in partners):
        raise ValueError("every partner of PALM needs an expert")
    learner, done = start or (start_palm(task, companions[0].task, settings, seed), 0)
    world = _worlds([one.task for one in companions], partners, training.episodes)
    for iteration in range(done, training.iterations):
        noise = noise_at(training, iteration)
        learner = learner._replace(robot=with_noise(learner.robot, noise))
        rng = np.random.default_rng([seed, iteration])
        student = policy_of(learner, settings)
        episodes = play_with(companions[0].task, world, student, partners, rng)
        key = jax.random.fold_in(jax.random.key(seed), iteration)
        learner = _learned(learner, episodes, partners, task, settings, key)
        success = float(np.mean(episodes.summary.success))
        report(Progress(iteration, float(episodes.returns.mean()), success, noise), learner)
    return learner


def held_out_prediction(
    tasks: Sequence[Task],
    partners: Sequence[Partner],
    learner: PalmLearner,
    settings: PalmSettings,
    *,
    episodes: int,
    seed: int,
) -> Prediction:
    """How well the robot predicts its partners in fresh episodes, in which it acts by its mean.

    Args:
        tasks: Of each partner, as the robot meets it.
        partners: They share the episodes as in training.
        learner: Finished.
        settings: Of its training.
        episodes: How many.
        seed: Of the training; these episodes draw from a part of it that no iteration reaches.
    """
    rng = np.random.default_rng([seed, settings.personalisation.iterations])
    world, blocks = _worlds(tasks, partners, episodes), _blocks(partners, episodes)
    robot = policy_actor(policy_of(learner, settings), episodes, None)
    humans = [
        policy_actor(partner.human, block.stop - block.start, rng)
        for partner, block in zip(partners, blocks, strict=True)
    ]
    seeds = rng.integers(2**31, size=episodes)
    played = play(tasks[0], world, seeds, robot, side_by_side(humans, blocks))
    motion, columns = settings.motion, shown_columns(tasks[0])
    sizes = {"memory": motion.memory, "ahead": motion.ahead}
    examples = motion_of(played.robot_observation, played.weight, columns, **sizes)
    steady = constant_velocity(examples.windows, columns, **sizes)
    predicted = np.asarray(_predict(learner.vae, examples.windows))
    return Prediction(root_mean_square(predicted, examples), root_mean_square(steady, examples))


def _learned(
    learner: PalmLearner,
    episodes: Trajectories,
    partners: Sequence[Partner],
    task: Task,
    settings: PalmSettings,
    key: jax.Array,
) -> PalmLearner:
    """The robot after an iteration; its policy learns with the latent that it acted on."""
    motion, training = settings.motion, settings.personalisation
    size = learner.vae.encoder.normaliser.mean.size
    visible = episodes.robot_observation[..., :size]
    windows = history_windows(visible, motion.memory)
    rollout = rollout_of(
        episodes,
        np.asarray(_with_latent(learner.vae.encoder, windows)),
        [partner.expert for partner in partners if partner.expert is not None],
        _blocks(partners, visible.shape[1]),
        task.robot,
        training.reward_scale,
    )
    robot_key, vae_key = jax.random.split(key)
    robot, _ = _update(learner.robot, rollout, robot_key, settings=training.ppo)
    columns = shown_columns(task)
    examples = motion_of(
        visible, episodes.weight, columns, memory=motion.memory, ahead=motion.ahead
    )
    vae, _ = _update_vae(learner.vae, examples, vae_key, settings=motion)
    return PalmLearner(robot, vae)


def _worlds(tasks: Sequence[Task], partners: Sequence[Partner], episodes: int) -> JoinedWorlds:
    blocks = _blocks(partners, episodes)
    return JoinedWorlds([
        task.make_world(block.stop - block.start)
        for task, block in zip(tasks, blocks, strict=True)
    ])  # fmt: skip


def _blocks(partners: Sequence[Partner], episodes: int) -> list[slice]:
    return blocks_of(episodes, [partner.share for partner in partners])

"""Where adversaries come to rest on tasks with exact answers: the real search in raw units.

Rewards and penalties keep their own units here (both standard deviations that the search would
divide by are 1), so that λ means what it means in the formulas. Everything else is the search's:
canonical episodes, PPO, discriminator, referee.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from rigid.data.recording import record
from rigid.learning.adversary import Adversary, start_adversary, train_iteration
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.group_play import Opponent, group_actor, phase_rng
from rigid.learning.ppo import PPOSettings
from rigid.learning.rollout import Trajectories, play, policy_actor
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.policies.gaussian import GaussianParameters, GaussianPolicy
from rigid.policies.loading import load_policy
from rigid.tasks.protocol import Task

LIGHT = DiscriminatorSettings(
    hidden=(16, 16), gradient_penalty=0.0, noise=0.05, noise_floor=0.05, learning_rate=3e-3,
    steps=30, replay_share=0.0,
)  # fmt: skip
"""A discriminator without stabilisers, whose optimum is the textbook one. One feature needs few
units; its rate lets it follow the adversary. Chosen once for every λ."""


@dataclass(frozen=True, kw_only=True)
class Effort:
    """How much is trained and measured; never chosen for one λ. All values ours."""

    seeds: tuple[int, ...] = (0, 1, 2, 3, 4)
    iterations: int = 120
    episodes: int = 1024
    """Of an iteration and adversary: 122,880 in all."""
    canonical: int = 20_000
    """Canonical episodes of a search."""
    scored: int = 20_000
    """Fresh episodes of each adversary, and canonical ones, for each part of the referee's work."""
    ppo: PPOSettings = field(
        default_factory=lambda: PPOSettings(
            learning_rate=1.5e-3, epochs=2, minibatch=512, update_normaliser=False
        )
    )


class Rested(NamedTuple):
    """An adversary that was trained, taken at the mean of its last iterations.

    Noise keeps a policy moving about its rest; the mean of the last third of the iterations (Polyak
    and Juditsky, 1992) is what is measured.
    """

    policy: GaussianParameters
    naturalness: float
    """Share of its newest steps, which no discriminator had seen yet, with D < 0, over the same
    iterations; NaN without a discriminator."""


def opponent_of(task: Task, robot: str, effort: Effort, seed: int) -> Opponent:
    """Robot, human and fresh canonical episodes, in raw units."""
    players = (
        load_policy(robot, task=task, agent="robot"),
        load_policy("builtin:synthetic-human", task=task, agent="human"),
    )
    human = players[1]
    assert isinstance(human, GaussianPolicy)
    canonical = record(
        task, *players, episodes=effort.canonical, seed=seed, batch=effort.canonical, provenance={}
    )
    return Opponent(
        players[0], human.parameters, canonical.features, canonical.seeds, reward_std=1.0
    )


def adversary_settings(
    effort: Effort,
    discriminator: DiscriminatorSettings = LIGHT,
    *,
    penalty: str = "amp",
    measure: str = "lsgan",
) -> AdversarySettings:
    """The search's settings at this effort; every adversary starts at the synthetic human."""
    return AdversarySettings(
        iterations=effort.iterations, episodes=effort.episodes, penalty=penalty, measure=measure,
        natural_start=0.0, ppo=effort.ppo, discriminator=discriminator,
    )  # fmt: skip


def come_to_rest(
    task: Task,
    opponent: Opponent,
    settings: AdversarySettings,
    lambdas: Sequence[float],
    seed: int,
    advance: Callable[[int], None],
    *,
    iterations: int | None = None,
) -> list[Rested]:
    """Trains one adversary for each λ with the search's own steps.

    Args:
        task: The task.
        opponent: From `opponent_of`.
        settings: From `adversary_settings`.
        lambdas: Weights, in raw units.
        seed: Everything random comes from it.
        advance: Told of environment steps.
        iterations: Stop earlier than the settings say.
    """
    keys = jax.random.split(jax.random.key(seed), len(lambdas))
    group = [
        start_adversary(opponent, settings, lambda_, key)._replace(penalty_std=jnp.ones(()))
        for lambda_, key in zip(lambdas, keys, strict=True)
    ]
    world = task.make_world(len(group) * settings.episodes)
    last: list[list[tuple[Adversary, float]]] = [[] for _ in group]
    iterations = settings.iterations if iterations is None else iterations
    for iteration in range(iterations):
        results = train_iteration(task, world, group, opponent, settings, seed)
        group = [adversary for adversary, _ in results]
        if 3 * iteration >= 2 * iterations:
            for history, (adversary, metrics) in zip(last, results, strict=True):
                history.append((adversary, float(metrics.naturalness_own)))
        advance(len(group) * settings.episodes * task.horizon)
    return [_mean(history) for history in last]


def _mean(history: Sequence[tuple[Adversary, float]]) -> Rested:
    policies = [adversary.learner.policy for adversary, _ in history]
    mean = jax.tree.map(lambda *leaves: jnp.mean(jnp.stack(leaves), axis=0), *policies)
    return Rested(mean, float(np.mean([natural for _, natural in history])))


def play_rested(
    task: Task, opponent: Opponent, rested: Sequence[Rested], episodes: int, seed: int
) -> list[Trajectories]:
    """Fresh episodes of each adversary."""
    rng = phase_rng(seed, "score")
    world = task.make_world(episodes)
    starts = rng.integers(2**31, size=episodes)
    return [
        play(
            task, world, starts, policy_actor(opponent.robot, episodes, None),
            group_actor([one.policy], rng),
        )
        for one in rested
    ]  # fmt: skip

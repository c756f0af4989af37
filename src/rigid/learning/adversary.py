"""Natural-adversarial humans: PPO against a frozen robot, held close by a search measure.

For a weight λ the adversary maximises, per step,

    -R / σ_R - λ · penalty / σ_P            (paper, Eq. 4; by default with Eq. 2's D)

σ_R is the per-step standard deviation of canonical reward, σ_P the measure's unit, by default the
deviation of the penalty on canonical motion before training; both are frozen. λ = ∞ drops the first
term. A group of adversaries, one for each λ, plays side by side in one set of worlds; each then
learns on its own rows.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int, PRNGKeyArray, Shaped

from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.group_play import (
    Experience,
    Opponent,
    Played,
    canonical_motion,
    phase_rng,
    play_group,
)
from rigid.learning.learner import Learner, Rollout
from rigid.learning.ppo import ppo_update, start_learner
from rigid.naturalness.measure import Health, Motion, unknown
from rigid.naturalness.standardise import canonical_scale, standardise
from rigid.policies.gaussian import GaussianParameters, with_memory
from rigid.policies.networks import MLP, init_mlp
from rigid.tasks.protocol import Task, World


class Adversary(NamedTuple):
    """One adversary in training; a pytree, so that it can be saved at any iteration."""

    learner: Learner
    measure: Any
    """State of the search measure; of a discriminator it is a `GanState`."""
    penalty_std: Float[Array, ""]
    """σ_P, frozen."""
    lambda_: Float[Array, ""]
    iteration: Int[Array, ""]


class Metrics(NamedTuple):
    """What one iteration saw."""

    mean_return: Float[Array, ""]
    success: Float[Array, ""]
    penalty: Float[Array, ""]
    naturalness_own: Float[Array, ""]
    """Share of steps that its own discriminator takes for canonical; NaN where it has none."""
    entropy: Float[Array, ""]
    health: Health


def start_adversary(
    opponent: Opponent, settings: AdversarySettings, lambda_: float, key: PRNGKeyArray
) -> Adversary:
    """A fresh adversary and its measure, before any step."""
    policy_key, critic_key, measure_key = jax.random.split(key, 3)
    canonical, measure = canonical_motion(opponent), settings.search_measure
    natural = lambda_ >= settings.natural_start
    policy, critic = first_networks(opponent, settings, (policy_key, critic_key), natural=natural)
    state = measure.start(measure_key, canonical, with_memory(opponent.human, settings.memory))
    return Adversary(
        start_learner(settings.ppo, policy, critic, policy.normaliser),
        state,
        measure.unit(state, canonical),
        jnp.asarray(lambda_, jnp.float32),
        jnp.asarray(0, jnp.int32),
    )


def first_networks(
    opponent: Opponent,
    settings: AdversarySettings,
    keys: tuple[PRNGKeyArray, PRNGKeyArray],
    *,
    natural: bool,
) -> tuple[GaussianParameters, MLP]:
    """Policy and critic before any step: the policy is the synthetic human, or random."""
    policy_key, critic_key = keys
    human = with_memory(opponent.human, settings.memory)
    sizes = [human.network[0]["w"].shape[0], *(layer["w"].shape[1] for layer in human.network)]
    if not natural:
        human = human._replace(network=init_mlp(policy_key, sizes, last_scale=0.01))
    return human, init_mlp(critic_key, (sizes[0] + 1, *sizes[1:-1], 1), last_scale=0.01)


def own_scores(
    adversary: Adversary,
    features: Float[np.ndarray, "N T f"],
    opponent: Opponent,
    settings: AdversarySettings,
) -> Float[np.ndarray, "N T"] | None:
    """What an adversary's own discriminator says of episodes, low for canonical.

    None where its search measure has no classifier.
    """
    seen = standardise(canonical_scale(opponent.canonical), features).swapaxes(0, 1)
    scores = settings.search_measure.score(adversary.measure, jnp.asarray(seen))
    return None if scores is None else np.asarray(scores).T


def train_iteration(
    task: Task,
    world: World,
    group: Sequence[Adversary],
    opponent: Opponent,
    settings: AdversarySettings,
    seed: int,
) -> list[tuple[Adversary, Metrics]]:
    """One iteration of every adversary: play, one policy update, one update of its measure.

    All randomness comes from (`seed`, iteration), so a group that was saved between two iterations
    goes on as if it had never stopped.
    """
    iteration = int(group[0].iteration)
    policies = [adversary.learner.policy for adversary in group]
    rng = phase_rng(seed, "train", iteration)
    played = play_group(task, world, policies, opponent, settings.episodes, settings.memory, rng)
    canonical = canonical_motion(opponent)
    key = jax.random.fold_in(jax.random.key(seed), iteration)
    results = []
    for index, adversary in enumerate(group):
        mine = slice(index * settings.episodes, (index + 1) * settings.episodes)
        experience = Experience(*(rows[:, mine] for rows in played.experience))
        updated, metrics = _update(
            adversary, experience, canonical, jax.random.fold_in(key, index), settings=settings
        )
        results.append((updated, seen_by_task(metrics, played, mine)))
    return results


@partial(jax.jit, static_argnames="settings")
def _update(
    adversary: Adversary,
    experience: Experience,
    canonical: Float[Array, "E T f"],
    key: PRNGKeyArray,
    *,
    settings: AdversarySettings,
) -> tuple[Adversary, Metrics]:
    observation, action, reward, weight, features = experience
    keys, measure = jax.random.split(key, 3), settings.search_measure
    motion, policy = Motion(features, weight, observation, action), adversary.learner.policy
    penalty = measure.penalty(adversary.measure, canonical, motion, policy)
    scores = measure.score(adversary.measure, features)
    shaped = shaped_reward(adversary.lambda_, reward, penalty / adversary.penalty_std)
    rollout = rollout_of(observation, action, shaped, weight)
    pace = pace_at(adversary.iteration, settings.iterations)
    learner, losses = ppo_update(adversary.learner, rollout, keys[0], settings.ppo, pace)
    state, health = measure.update(
        adversary.measure, canonical, motion, policy, adversary.iteration, keys[1:]
    )
    metrics = Metrics(
        mean_return=jnp.zeros(()),
        success=jnp.zeros(()),
        penalty=mean_of_sound(penalty, weight),
        naturalness_own=unknown() if scores is None else mean_of_sound(scores < 0, weight),
        entropy=losses.entropy,
        health=health,
    )
    after = Adversary(
        learner, state, adversary.penalty_std, adversary.lambda_, adversary.iteration + 1
    )
    return after, metrics


def seen_by_task(metrics: Metrics, played: Played, mine: slice) -> Metrics:
    """The metrics of a block of episodes with what the task says of them."""
    return metrics._replace(
        mean_return=played.returns[mine].mean(), success=np.mean(played.success[mine])
    )


def mean_of_sound(x: Shaped[Array, "T N"], weight: Float[Array, "T N"]) -> Float[Array, ""]:
    """Mean over the steps that count."""
    return (x * weight).sum() / jnp.maximum(weight.sum(), 1.0)


def rollout_of(
    observation: Float[Array, "T N o"],
    action: Float[Array, "T N a"],
    reward: Float[Array, "T N"],
    weight: Float[Array, "T N"],
) -> Rollout:
    """What PPO learns from: the critic sees what the policy sees, and nobody is imitated."""
    return Rollout(
        observation=observation,
        critic_observation=observation,
        action=action,
        reward=weight * reward,
        weight=weight,
        expert_action=jnp.zeros_like(action),
    )


def pace_at(iteration: Int[Array, ""] | float, iterations: int) -> Float[Array, ""]:
    """Share of the learning rate: from 0 to 1 in three iterations, then linearly down to 0.

    Ours. A fresh critic would first push a policy that starts at the synthetic human away from it,
    and a constant rate would keep it wandering until the end.
    """
    rise = jnp.minimum(iteration / 3, 1.0)
    return rise * (1 - iteration / iterations)


def shaped_reward(
    lambda_: Float[Array, "*step"], reward: Float[Array, "T N"], penalty: Float[Array, "T N"]
) -> Float[Array, "T N"]:
    """What the adversary maximises per step; both streams in their own frozen unit.

    The common factor moves no optimum; it keeps the critic's targets near 1 for every λ.
    """
    only_natural = jnp.isinf(lambda_)
    task_weight = jnp.where(only_natural, 0.0, 1.0)
    natural_weight = jnp.where(only_natural, 1.0, lambda_)
    total = -task_weight * reward - natural_weight * penalty
    return 0.1 * total / (task_weight + natural_weight)

"""Proximal policy optimisation for fixed-horizon episodes (Schulman et al., 2017).

One learner is a policy, a critic and their optimiser; every function takes one learner and is
`vmap`-ped by callers that train several side by side. T denotes steps, N episodes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import jax
import jax.numpy as jnp
import optax
from jaxtyping import Array, Float, PRNGKeyArray

from rigid.learning.advantages import advantages, signal_share, standardised
from rigid.learning.learner import (
    Learner,
    Rollout,
    Trainable,
    critic_values,
    trainable_of,
    with_time,
)
from rigid.policies.gaussian import GaussianParameters, init_gaussian, log_density, mean_action
from rigid.policies.networks import (
    MLP,
    Normaliser,
    apply_mlp,
    init_mlp,
    init_normaliser,
    normalise,
    update_normaliser,
)


@dataclass(frozen=True, kw_only=True)
class PPOSettings:
    """Hyper-parameters of PPO; defaults are the common ones, marked where the paper departs."""

    learning_rate: float = 3e-4
    gamma: float = 0.99
    """Discount. The paper's appendix prints 0.09 for robots, which cannot see past three steps of
    100 and is read as a slip for 0.99."""
    gae_lambda: float = 0.95
    clip: float = 0.2
    epochs: int = 8
    minibatch: int = 2400
    """Samples of a gradient step."""
    value_coefficient: float = 0.5
    learn_std: bool = False
    """Whether the action noise is learned. Ours: no, it is scheduled by the caller, since an
    entropy bonus stalls co-optimisation and adversaries keep the synthetic human's noise."""
    max_gradient_norm: float = 0.5
    cloning_coefficient: float = 0.0
    """Weight of the squared distance to an expert's mean action; 0: no expert."""
    policy_coefficient: float = 1.0
    update_normaliser: bool = True
    signal_floor: float = 0.0
    """Advantages with a smaller standard deviation than this shorten the step in proportion. PPO
    standardises advantages and Adam the gradient, so that even a policy with nothing left to gain
    walks at full pace, led by noise; with a floor it comes to rest. 0: plain PPO. Ours."""


class Losses(NamedTuple):
    """Means over the last epoch."""

    policy: Float[Array, ""]
    value: Float[Array, ""]
    cloning: Float[Array, ""]
    entropy: Float[Array, ""]
    clipped_share: Float[Array, ""]


def make_optimiser(settings: PPOSettings) -> optax.GradientTransformation:
    """Adam behind a clip of the global gradient norm."""
    return optax.chain(
        optax.clip_by_global_norm(settings.max_gradient_norm),
        optax.adam(settings.learning_rate, eps=1e-5),
    )


def init_learner(
    key: PRNGKeyArray,
    settings: PPOSettings,
    *,
    observation_size: int,
    critic_observation_size: int,
    action_size: int,
    hidden: Sequence[int],
    std: float = 0.5,
    memory: int = 1,
) -> Learner:
    """A random policy and critic of the same hidden sizes."""
    policy_key, critic_key = jax.random.split(key)
    policy = init_gaussian(
        policy_key, observation_size, action_size, hidden, std=std, memory=memory
    )
    critic = init_mlp(critic_key, (critic_observation_size + 1, *hidden, 1))
    return start_learner(settings, policy, critic, init_normaliser(critic_observation_size))


def start_learner(
    settings: PPOSettings,
    policy: GaussianParameters,
    critic: MLP,
    critic_normaliser: Normaliser,
) -> Learner:
    """A learner that starts from given networks with a fresh optimiser."""
    optimiser = make_optimiser(settings).init(trainable_of(policy, critic))
    return Learner(policy, critic, critic_normaliser, optimiser)


def ppo_update(
    learner: Learner,
    rollout: Rollout,
    key: PRNGKeyArray,
    settings: PPOSettings,
    pace: Float[Array, ""] | float = 1.0,
    blocks: int = 1,
) -> tuple[Learner, Losses]:
    """One iteration of PPO on one rollout; `settings` and `blocks` must be static under `jit`.

    Args:
        learner: Policy, critic and optimiser before the iteration.
        rollout: Episodes that this policy played.
        key: Consumed.
        settings: Hyper-parameters.
        pace: Factor on the policy's learning rate, for schedules.
        blocks: The N episodes are this many equal blocks of different aims, whose advantages are
            standardised each on its own.
    """
    if settings.update_normaliser:
        # Moments of this rollout first serve the next one: the policy that acted is the old one.
        fresh = update_normaliser(learner.policy.normaliser, rollout.observation)
        fresh_critic = update_normaliser(learner.critic_normaliser, rollout.critic_observation)
    else:
        fresh, fresh_critic = learner.policy.normaliser, learner.critic_normaliser
    value = critic_values(learner, rollout.critic_observation)
    gain = advantages(
        rollout.reward,
        value,
        gamma=settings.gamma,
        gae_lambda=settings.gae_lambda,
        weight=rollout.weight,
    )
    share, strongest = signal_share(gain, rollout.weight, settings.signal_floor, blocks)
    mean = mean_action(learner.policy, rollout.observation)
    samples = {
        "observation": normalise(learner.policy.normaliser, rollout.observation),
        "critic": with_time(learner.critic_normaliser, rollout.critic_observation),
        "action": rollout.action,
        "expert": rollout.expert_action,
        "log_density": log_density(mean, learner.policy.log_std, rollout.action),
        "advantage": share * standardised(gain, rollout.weight, blocks),
        "target": gain + value,
        "weight": rollout.weight,
    }
    count = rollout.reward.size
    flat = {name: x.reshape(count, *x.shape[2:]) for name, x in samples.items()}
    learner, losses = _epochs(learner, flat, key, settings, pace * strongest)
    policy = learner.policy._replace(normaliser=fresh)
    return learner._replace(policy=policy, critic_normaliser=fresh_critic), losses


def _epochs(
    learner: Learner,
    samples: dict[str, Array],
    key: PRNGKeyArray,
    settings: PPOSettings,
    pace: Float[Array, ""] | float,
) -> tuple[Learner, Losses]:
    count = samples["weight"].shape[0]
    batches = max(count // settings.minibatch, 1)
    size = count // batches
    orders = jax.vmap(lambda k: jax.random.permutation(k, count)[: batches * size])(
        jax.random.split(key, settings.epochs)
    ).reshape(settings.epochs * batches, size)
    optimiser = make_optimiser(settings)

    def step(carry: Learner, order: Array) -> tuple[Learner, Losses]:
        batch = {name: x[order] for name, x in samples.items()}
        trainable = trainable_of(carry.policy, carry.critic)
        gradient, losses = jax.grad(_loss, has_aux=True)(trainable, batch, settings)
        updates, state = optimiser.update(gradient, carry.optimiser, trainable)
        for part in ("network", "log_std"):  # The critic always learns at its own rate.
            updates[part] = jax.tree.map(lambda x: pace * x, updates[part])
        new = optax.apply_updates(trainable, updates)
        if not settings.learn_std:
            new["log_std"] = trainable["log_std"]
        policy = carry.policy._replace(network=new["network"], log_std=new["log_std"])
        return carry._replace(policy=policy, critic=new["critic"], optimiser=state), losses

    learner, losses = jax.lax.scan(step, learner, orders)
    return learner, jax.tree.map(lambda x: x[-batches:].mean(), losses)


def _loss(
    trainable: Trainable, batch: dict[str, Array], settings: PPOSettings
) -> tuple[Float[Array, ""], Losses]:
    mean = apply_mlp(trainable["network"], batch["observation"])
    density = log_density(mean, trainable["log_std"], batch["action"])
    gain, weight = batch["advantage"], batch["weight"]
    # What follows a fault weighs nothing, and must not spoil a sum by being infinite.
    ratio = jnp.exp(jnp.where(weight > 0, density - batch["log_density"], 0.0))
    clipped = jnp.clip(ratio, 1 - settings.clip, 1 + settings.clip)
    total = jnp.maximum(weight.sum(), 1.0)
    policy = -(jnp.minimum(ratio * gain, clipped * gain) * weight).sum() / total
    error = apply_mlp(trainable["critic"], batch["critic"])[:, 0] - batch["target"]
    value = 0.5 * (error**2 * weight).sum() / total
    cloning = (((mean - batch["expert"]) ** 2).sum(axis=-1) * weight).sum() / total
    loss = settings.policy_coefficient * policy + settings.value_coefficient * value
    loss = loss + settings.cloning_coefficient * cloning
    entropy = jnp.sum(trainable["log_std"]) + 0.5 * mean.shape[-1] * jnp.log(2 * jnp.pi * jnp.e)
    outside = (jnp.abs(ratio - 1) > settings.clip).mean()
    return loss, Losses(policy, value, cloning, entropy, outside)

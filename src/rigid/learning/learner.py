"""A policy and a critic in training, and the episodes that they learn from.

The critic sees the time left, the policy does not: episodes end after exactly T steps, so the value
of a state depends on time, and a baseline may look at anything without biasing the gradient. T
denotes steps, N episodes.
"""

from __future__ import annotations

from typing import NamedTuple, TypedDict

import jax.numpy as jnp
import optax
from jaxtyping import Array, Float

from rigid.policies.gaussian import GaussianParameters
from rigid.policies.networks import MLP, Normaliser, apply_mlp, normalise


class Learner(NamedTuple):
    """A policy and a critic in training."""

    policy: GaussianParameters
    critic: MLP
    critic_normaliser: Normaliser
    optimiser: optax.OptState


class Rollout(NamedTuple):
    """N episodes of T steps as one learner saw them."""

    observation: Float[Array, "T N o"]
    critic_observation: Float[Array, "T N c"]
    action: Float[Array, "T N a"]
    """Actions as sampled, before clipping."""
    reward: Float[Array, "T N"]
    weight: Float[Array, "T N"]
    """1, or 0 from the step on at which physics ran away."""
    expert_action: Float[Array, "T N a"]
    """What the expert would do; ignored without cloning."""


class Trainable(TypedDict):
    """What gradients move; a dict, whose sorted keys order the leaves of the optimiser's state."""

    network: MLP
    log_std: Float[Array, " a"]
    critic: MLP


def trainable_of(policy: GaussianParameters, critic: MLP) -> Trainable:
    """What gradients move of a policy and its critic."""
    return {"network": policy.network, "log_std": policy.log_std, "critic": critic}


def with_noise(learner: Learner, std: float) -> Learner:
    """The learner with every action's standard deviation set to `std`."""
    log_std = jnp.full_like(learner.policy.log_std, jnp.log(std))
    return learner._replace(policy=learner.policy._replace(log_std=log_std))


def critic_values(learner: Learner, observation: Float[Array, "T N c"]) -> Float[Array, "T N"]:
    """The critic's estimate at every step, given the share of the episode that is left."""
    return apply_mlp(learner.critic, with_time(learner.critic_normaliser, observation))[..., 0]


def with_time(normaliser: Normaliser, observation: Float[Array, "T N c"]) -> Float[Array, "T N c1"]:
    """What the critic's network is given: the share of the episode that is left comes last."""
    steps, episodes = observation.shape[:2]
    left = 1 - jnp.arange(steps, dtype=jnp.float32) / steps
    column = jnp.broadcast_to(left[:, None, None], (steps, episodes, 1))
    return jnp.concatenate([normalise(normaliser, observation), column], axis=-1)

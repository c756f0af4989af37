"""Policies written down instead of trained: linear Gaussian ones whose weights are formulas."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from rigid.policies.gaussian import GaussianParameters, GaussianPolicy
from rigid.policies.networks import Normaliser

_NO_NOISE = 1e-6
"""Standard deviation of a policy that is only ever asked for its mean."""


def linear_policy(weights: Float[np.ndarray, "o a"]) -> GaussianPolicy:
    """Acts `observation @ weights`, for robots, which take their mean action.

    Args:
        weights: Actions (in [-1, 1]) per unit of each observed number.
    """
    observed, actions = weights.shape
    return _policy(weights, np.full(actions, _NO_NOISE), np.ones(observed))


def noise_policy(
    std: Float[np.ndarray, " a"], observation_scale: Float[np.ndarray, " o"]
) -> GaussianPolicy:
    """Acts by noise alone: mean 0 whatever it sees. Adversaries that start from it are linear.

    Args:
        std: Standard deviation of each action, in units of a full action.
        observation_scale: Typical size of each observed number; the network sees multiples of it.
    """
    return _policy(np.zeros((len(observation_scale), len(std))), std, observation_scale)


def _policy(
    weights: Float[np.ndarray, "o a"], std: Float[np.ndarray, " a"], scale: Float[np.ndarray, " o"]
) -> GaussianPolicy:
    zero, variance, rows = (
        jnp.asarray(x, jnp.float32) for x in (np.zeros(len(scale)), scale**2, 1.0)
    )
    bias = jnp.zeros(weights.shape[1], jnp.float32)
    network = [{"w": jnp.asarray(weights, jnp.float32), "b": bias}]
    log_std = jnp.asarray(np.log(std), jnp.float32)
    return GaussianPolicy(GaussianParameters(network, log_std, Normaliser(zero, variance, rows)))

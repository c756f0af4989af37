"""Gaussian actions that the task clips: how likely they are, and how much they vary.

A task clips actions to [-1, 1], so a recorded 1 stands for everything from 1 on: its likelihood is
that of a censored Gaussian (Tobin, 1958). Without it a clone of somebody who often does all he can
would be too timid and too sure.
"""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import scipy.special
from jaxtyping import Array, Float
from scipy.optimize import minimize_scalar

CENSORED = 1 - 1e-4
"""Actions of at least this size are taken for clipped ones: exports round. Ours."""
_WIDEST = 5.0
"""Largest standard deviation: two and a half times the range of an action. Ours."""
Numbers = Array | np.ndarray


def censored_log_likelihood(
    mean: Float[Numbers, "*n a"],
    log_std: Float[Numbers, " a"],
    action: Float[Numbers, "*n a"],
    library: Any = jnp,
) -> Float[Numbers, "*n a"]:
    """Of each number of an action: density inside (-1, 1), mass of what was clipped at the ends.

    Args:
        mean: Of the action, not clipped.
        log_std: Of the noise.
        action: In [-1, 1].
        library: `jnp` where gradients are wanted, else `np`, which compiles nothing.
    """
    log_mass = jax.scipy.special.log_ndtr if library is jnp else scipy.special.log_ndtr
    log_std = library.broadcast_to(log_std, mean.shape)
    std = library.exp(log_std)
    inside = -0.5 * ((action - mean) / std) ** 2 - log_std - 0.5 * np.log(2 * np.pi)
    above, below = log_mass((mean - 1) / std), log_mass((-1 - mean) / std)
    ends = library.where(action <= -CENSORED, below, inside)
    likely: Numbers = library.where(action >= CENSORED, above, ends)
    return likely


def mean_likelihood(mean: np.ndarray, log_std: np.ndarray, done: np.ndarray) -> float:
    """Mean log-likelihood of a step: all numbers of an action together."""
    likely = censored_log_likelihood(mean, log_std, done, np)
    return float(likely.sum(axis=-1).mean())


def calibrated(
    mean: Float[np.ndarray, "n a"], done: Float[np.ndarray, "n a"], least: float
) -> Float[np.ndarray, " a"]:
    """The log standard deviation of each action under which what was done is the likeliest.

    Args:
        mean: What was expected.
        done: What was done.
        least: Standard deviation that is assumed at least.
    """

    def best(index: int) -> float:
        column = slice(index, index + 1)

        def loss(log_std: float) -> float:
            return -mean_likelihood(mean[:, column], np.array([log_std]), done[:, column])

        # One peak: the censored likelihood is log-concave in 1/std and mean/std (Olsen, 1978).
        found = minimize_scalar(loss, bounds=(np.log(least), np.log(_WIDEST)), method="bounded")
        return float(found.x)

    return np.array([best(index) for index in range(mean.shape[1])])

"""RIGID's own policy: a tanh network with Gaussian actions and an optional window of history."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, PRNGKeyArray

from rigid.policies.networks import MLP, Normaliser, apply_mlp, init_mlp, init_normaliser, normalise


class GaussianParameters(NamedTuple):
    """Everything a Gaussian policy needs to act."""

    network: MLP
    log_std: Float[Array, " a"]
    normaliser: Normaliser


def init_gaussian(
    key: PRNGKeyArray,
    observation_size: int,
    action_size: int,
    hidden: Sequence[int],
    *,
    std: float,
    memory: int = 1,
) -> GaussianParameters:
    """Random parameters with nearly zero mean actions and the same `std` for every action."""
    sizes = (observation_size * memory, *hidden, action_size)
    return GaussianParameters(
        init_mlp(key, sizes, last_scale=0.01),
        jnp.full(action_size, jnp.log(std), jnp.float32),
        init_normaliser(observation_size * memory),
    )


def mean_action(
    parameters: GaussianParameters, observation: Float[Array, "*batch o"]
) -> Float[Array, "*batch a"]:
    """Mean of the action distribution; sampled actions are clipped to [-1, 1] by the task."""
    return apply_mlp(parameters.network, normalise(parameters.normaliser, observation))


def log_density(
    mean: Float[Array, "*batch a"], log_std: Float[Array, " a"], action: Float[Array, "*batch a"]
) -> Float[Array, "*batch"]:
    """Log-density of (unclipped) actions under a diagonal Gaussian."""
    spread = jnp.broadcast_to(log_std, mean.shape)
    z = (action - mean) * jnp.exp(-spread)
    return jnp.sum(-0.5 * z**2 - spread - 0.5 * jnp.log(2 * jnp.pi), axis=-1)


_jitted_mean = jax.jit(mean_action)


class GaussianPolicy:
    """A Gaussian policy as a `Policy`: acts in NumPy, computes in JAX.

    With `memory` K > 1 it sees its last K observations, newest first, as the paper's human acts on
    local histories; before the episode's K-th step the oldest observation is repeated.
    """

    def __init__(self, parameters: GaussianParameters, *, memory: int = 1) -> None:
        self.parameters, self.memory = parameters, memory
        self.observation_size = int(parameters.network[0]["w"].shape[0]) // memory
        self.action_size = int(parameters.log_std.shape[0])
        self._std = np.exp(np.asarray(parameters.log_std, dtype=np.float64))

    def initial_state(self, batch: int) -> Float[np.ndarray, "B past"] | tuple[()]:
        """No history yet: NaN marks steps before the episode began."""
        if self.memory == 1:
            return ()
        return np.full((batch, (self.memory - 1) * self.observation_size), np.nan, np.float32)

    def act(
        self,
        observation: Float[np.ndarray, "B o"],
        state: Float[np.ndarray, "B past"] | tuple[()],
        rng: np.random.Generator | None,
    ) -> tuple[Float[np.ndarray, "B a"], Float[np.ndarray, "B past"] | tuple[()]]:
        """Mean action, plus Gaussian noise when `rng` is given.

        Not clipped: that is the task's, which alone knows whether these are reals or scores.
        """
        return self.sample(observation, state, rng)

    def sample(
        self,
        observation: Float[np.ndarray, "B o"],
        state: Float[np.ndarray, "B past"] | tuple[()],
        rng: np.random.Generator | None,
    ) -> tuple[Float[np.ndarray, "B a"], Float[np.ndarray, "B past"] | tuple[()]]:
        """The same, for training: PPO needs to know the density of an action."""
        window = stack_history(observation, state)
        action = np.asarray(_jitted_mean(self.parameters, window), dtype=np.float64)
        if rng is not None:
            action = action + self._std * rng.standard_normal(action.shape)
        if self.memory > 1:
            state = window[:, : -self.observation_size]
        return action, state


def stack_history(
    observation: Float[np.ndarray, "B o"], past: Float[np.ndarray, "B past"] | tuple[()]
) -> Float[np.ndarray, "B window"]:
    """Joins an observation with the ones before it, newest first; NaN past repeats the oldest."""
    if isinstance(past, tuple):
        return observation
    size = observation.shape[1]
    window = np.concatenate([observation, past.astype(observation.dtype)], axis=1)
    for start in range(size, window.shape[1], size):
        block = window[:, start : start + size]
        missing = np.isnan(block[:, :1])
        window[:, start : start + size] = np.where(missing, window[:, start - size : start], block)
    return window


def history_windows(
    observation: Float[np.ndarray, "T N o"], memory: int
) -> Float[np.ndarray, "T N window"]:
    """The last `memory` observations at every step, newest first; the first one is repeated."""
    steps = np.arange(len(observation))
    blocks = [observation[np.maximum(steps - age, 0)] for age in range(memory)]
    return np.concatenate(blocks, axis=-1)


def with_memory(parameters: GaussianParameters, memory: int) -> GaussianParameters:
    """A memoryless policy that is given its last `memory` observations, and acts as before."""
    first, *rest = parameters.network
    size = first["w"].shape[0]
    weights = jnp.zeros((size * memory, first["w"].shape[1])).at[:size].set(first["w"])
    mean, variance, count = parameters.normaliser
    return GaussianParameters(
        [first | {"w": weights}, *rest],
        parameters.log_std,
        Normaliser(jnp.tile(mean, memory), jnp.tile(variance, memory), count),
    )


@jax.jit
def group_mean_action(
    parameters: GaussianParameters, observation: Float[Array, "G B o"]
) -> Float[Array, "G B a"]:
    """Mean actions of G policies with the same architecture, each in its own B worlds."""
    return jax.vmap(mean_action)(parameters, observation)

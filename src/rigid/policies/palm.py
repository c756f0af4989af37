"""A policy that first embeds how the human has moved (PALM; He et al., 2022, and the paper).

A recurrent encoder reads the last observations into a latent vector z; a Gaussian policy acts on
the newest observation and z. The encoder is half of a variational autoencoder that predicts the
human's next motion (`rigid.learning.motion_vae`); acting needs only the mean of z.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from rigid.policies.gaussian import GaussianParameters, mean_action, stack_history
from rigid.policies.networks import Layer, Normaliser, apply_gru, apply_mlp, normalise


class MotionEncoder(NamedTuple):
    """From a window of observations to the mean of the latent."""

    recurrent: Layer
    """A gated recurrent unit (`init_gru`)."""
    mean: Layer
    normaliser: Normaliser
    """Of one observation."""
    change: Normaliser
    """Of the difference between an observation and the one before it."""


class PalmParameters(NamedTuple):
    """Everything a PALM policy needs to act."""

    encoder: MotionEncoder
    head: GaussianParameters
    """Acts on the newest observation and the latent, joined."""


def summary_of(
    encoder: MotionEncoder, windows: Float[Array, "*batch w"]
) -> Float[Array, "*batch h"]:
    """The recurrent state after reading each window of observations, which has the newest first.

    Every observation is read with its difference from the one before, each in its own standard
    deviations: motion within a step is small beside the differences between places.
    """
    size = encoder.normaliser.mean.shape[0]
    state = jnp.zeros((*windows.shape[:-1], encoder.mean["w"].shape[0]))
    before = windows[..., -size:]
    for start in range(windows.shape[-1] - size, -1, -size):
        newer = windows[..., start : start + size]
        seen = [normalise(encoder.normaliser, newer), normalise(encoder.change, newer - before)]
        state = apply_gru(encoder.recurrent, state, jnp.concatenate(seen, axis=-1))
        before = newer
    return state


def encode(encoder: MotionEncoder, windows: Float[Array, "*batch w"]) -> Float[Array, "*batch z"]:
    """Mean of the latent given each window of observations."""
    return apply_mlp([encoder.mean], summary_of(encoder, windows))


def with_latent(
    encoder: MotionEncoder, windows: Float[Array, "*batch w"]
) -> Float[Array, "*batch oz"]:
    """What the head sees: the newest observation and the latent."""
    size = encoder.normaliser.mean.shape[0]
    return jnp.concatenate([windows[..., :size], encode(encoder, windows)], axis=-1)


@jax.jit
def _mean(
    parameters: PalmParameters, windows: Float[Array, "*batch w"]
) -> Float[Array, "*batch a"]:
    return mean_action(parameters.head, with_latent(parameters.encoder, windows))


class PalmPolicy:
    """PALM as a `Policy`: acts in NumPy, computes in JAX.

    Before the episode's `memory`-th step the oldest observation is repeated.
    """

    def __init__(self, parameters: PalmParameters, *, memory: int) -> None:
        self.parameters, self.memory = parameters, memory
        self.observation_size = int(parameters.encoder.normaliser.mean.shape[0])
        self.action_size = int(parameters.head.log_std.shape[0])
        self._std = np.exp(np.asarray(parameters.head.log_std, dtype=np.float64))

    def initial_state(self, batch: int) -> Float[np.ndarray, "B past"]:
        """No history yet: NaN marks steps before the episode began."""
        return np.full((batch, (self.memory - 1) * self.observation_size), np.nan, np.float32)

    def act(
        self,
        observation: Float[np.ndarray, "B o"],
        state: Float[np.ndarray, "B past"],
        rng: np.random.Generator | None,
    ) -> tuple[Float[np.ndarray, "B a"], Float[np.ndarray, "B past"]]:
        """Mean action, plus Gaussian noise when `rng` is given.

        Not clipped: that is the task's, which alone knows whether these are reals or scores.
        """
        return self.sample(observation, state, rng)

    def sample(
        self,
        observation: Float[np.ndarray, "B o"],
        state: Float[np.ndarray, "B past"],
        rng: np.random.Generator | None,
    ) -> tuple[Float[np.ndarray, "B a"], Float[np.ndarray, "B past"]]:
        """The same, for training: PPO needs to know the density of an action."""
        window = stack_history(observation, state)
        action = np.asarray(_mean(self.parameters, window), dtype=np.float64)
        if rng is not None:
            action = action + self._std * rng.standard_normal(action.shape)
        return action, window[:, : window.shape[1] - self.observation_size]

"""RIGID's own policies in plain NumPy, for one world at a time.

Of a small network on one world, JAX's dispatch is most of the time, and its first call compiles.
The numbers are those of JAX to the last digits of float32.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import jax
import numpy as np
from jaxtyping import Float

from rigid.policies.gaussian import GaussianParameters, GaussianPolicy, stack_history
from rigid.policies.networks import OBSERVATION_CLIP, Normaliser
from rigid.policies.palm import MotionEncoder, PalmParameters, PalmPolicy
from rigid.policies.protocol import Policy, State

_Layer = Mapping[str, Any]
"""As `rigid.policies.networks.Layer`, of NumPy arrays."""


def in_numpy(policy: Policy) -> Policy:
    """A policy that acts as `policy` does; `policy` itself where it does not compute in JAX."""
    if isinstance(policy, GaussianPolicy | PalmPolicy):
        return NumpyPolicy(policy)
    return policy


class NumpyPolicy:
    """A native policy that computes in NumPy; see `GaussianPolicy` and `PalmPolicy`."""

    def __init__(self, policy: GaussianPolicy | PalmPolicy) -> None:
        self.observation_size, self.action_size = policy.observation_size, policy.action_size
        self.memory, self._start = policy.memory, policy.initial_state
        # In float64, so that nothing but JAX's own rounding lies between the two.
        self._parameters: GaussianParameters | PalmParameters = jax.tree.map(
            lambda weights: np.asarray(weights, dtype=np.float64), policy.parameters
        )

    def initial_state(self, batch: int) -> State:
        """The state before the first step of an episode."""
        return self._start(batch)

    def act(
        self, observation: Float[np.ndarray, "B o"], state: State, rng: np.random.Generator | None
    ) -> tuple[Float[np.ndarray, "B a"], State]:
        """Mean action, plus Gaussian noise when `rng` is given; not clipped."""
        window, head = stack_history(observation, state), self._parameters
        seen = window
        if isinstance(head, PalmParameters):
            seen, head = _with_latent(head.encoder, window), head.head
        action = _through(head.network, _normalised(head.normaliser, seen))
        if rng is not None:
            action = action + np.exp(head.log_std) * rng.standard_normal(action.shape)
        if not isinstance(state, tuple):
            state = window[:, : window.shape[1] - self.observation_size]
        return action, state


def _through(network: Sequence[_Layer], x: Float[np.ndarray, "B i"]) -> Float[np.ndarray, "B o"]:
    """As `rigid.policies.networks.apply_mlp`."""
    for layer in network[:-1]:
        x = np.tanh(x @ layer["w"] + layer["b"])
    return np.asarray(x @ network[-1]["w"] + network[-1]["b"])


def _normalised(moments: Normaliser, x: Float[np.ndarray, "B o"]) -> Float[np.ndarray, "B o"]:
    """As `rigid.policies.networks.normalise`."""
    apart = (x - moments.mean) / np.sqrt(moments.variance + 1e-6)
    # `np.clip` takes as long as a whole layer.
    return np.asarray(np.minimum(np.maximum(apart, -OBSERVATION_CLIP), OBSERVATION_CLIP))


def _with_latent(
    encoder: MotionEncoder, windows: Float[np.ndarray, "B w"]
) -> Float[np.ndarray, "B oz"]:
    """As `rigid.policies.palm.with_latent`."""
    size = len(encoder.normaliser.mean)
    state = np.zeros((len(windows), encoder.mean["w"].shape[0]))
    before = windows[:, -size:]
    for start in range(windows.shape[1] - size, -1, -size):
        newer = windows[:, start : start + size]
        seen = [_normalised(encoder.normaliser, newer), _normalised(encoder.change, newer - before)]
        state = _remembered(encoder.recurrent, state, np.concatenate(seen, axis=1))
        before = newer
    return np.concatenate([windows[:, :size], _through([encoder.mean], state)], axis=1)


def _remembered(
    unit: _Layer, state: Float[np.ndarray, "B h"], x: Float[np.ndarray, "B i"]
) -> Float[np.ndarray, "B h"]:
    """As `rigid.policies.networks.apply_gru`."""
    seen = np.split(x @ unit["w"] + unit["b"], 3, axis=1)
    kept = np.split(state @ unit["u"], 3, axis=1)
    # (1 + tanh(x/2))/2 is the logistic function, and does not overflow.
    reset, update = (
        (1 + np.tanh((a + b) / 2)) / 2 for a, b in zip(seen[:2], kept[:2], strict=True)
    )
    candidate = np.tanh(seen[2] + reset * kept[2])
    return np.asarray(update * state + (1 - update) * candidate)

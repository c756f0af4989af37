"""Networks as plain pytrees: fully connected layers, a recurrent one, running normalisation.

A network is a list of `{"w": [in, out], "b": [out]}`; one sample goes in and one comes out, and
batches are made by the caller's matrix products (the last axis is the feature axis everywhere).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, PRNGKeyArray

Layer = dict[str, Array]
MLP = list[Layer]

OBSERVATION_CLIP = 10.0
"""Normalised observations are clipped to this many standard deviations (common PPO practice)."""


def init_mlp(key: PRNGKeyArray, sizes: Sequence[int], *, last_scale: float = 1.0) -> MLP:
    """Orthogonal layers for `sizes` = (in, hidden…, out); gain √2, `last_scale` on the last one."""
    keys = jax.random.split(key, len(sizes) - 1)
    gains = [2.0**0.5] * (len(sizes) - 2) + [last_scale]
    layers = []
    for layer_key, gain, fan_in, fan_out in zip(keys, gains, sizes[:-1], sizes[1:], strict=True):
        weights = jax.nn.initializers.orthogonal(gain)(layer_key, (fan_in, fan_out), jnp.float32)
        layers.append({"w": weights, "b": jnp.zeros(fan_out)})
    return layers


def apply_mlp(network: MLP, x: Float[Array, "*batch i"]) -> Float[Array, "*batch o"]:
    """Tanh network with a linear last layer."""
    for layer in network[:-1]:
        x = jnp.tanh(_affine(layer, x))
    return _affine(network[-1], x)


def _affine(layer: Layer, x: Float[Array, "*batch i"]) -> Float[Array, "*batch o"]:
    product = x @ layer["w"]
    return product + jnp.broadcast_to(layer["b"], product.shape)


def init_layer(key: PRNGKeyArray, fan_in: int, fan_out: int, *, scale: float = 1.0) -> Layer:
    """A linear layer on its own."""
    return init_mlp(key, (fan_in, fan_out), last_scale=scale)[0]


def init_gru(key: PRNGKeyArray, fan_in: int, width: int) -> Layer:
    """A gated recurrent unit (Cho et al., 2014): `w` [in, 3 width], `u` [width, 3 width], `b`.

    The three blocks are the reset gate, the update gate and the candidate.
    """
    bound = width**-0.5  # As PyTorch.
    rows = jax.random.uniform(key, (fan_in + width, 3 * width), minval=-bound, maxval=bound)
    return {"w": rows[:fan_in], "u": rows[fan_in:], "b": jnp.zeros(3 * width)}


def apply_gru(
    unit: Layer, state: Float[Array, "*batch h"], x: Float[Array, "*batch i"]
) -> Float[Array, "*batch h"]:
    """The state after one more input."""
    seen = jnp.split(_affine(unit, x), 3, axis=-1)
    kept = jnp.split(state @ unit["u"], 3, axis=-1)
    reset, update = (jax.nn.sigmoid(a + b) for a, b in zip(seen[:2], kept[:2], strict=True))
    candidate = jnp.tanh(seen[2] + reset * kept[2])
    return update * state + (1 - update) * candidate


class Normaliser(NamedTuple):
    """Running mean and variance of observations, frozen once training ends."""

    mean: Float[Array, " o"]
    variance: Float[Array, " o"]
    count: Float[Array, ""]  # type: ignore[assignment]  # Its name is on disk; hides `tuple.count`.
    """Rows behind the moments."""


def init_normaliser(size: int) -> Normaliser:
    """A normaliser that changes nothing yet."""
    return Normaliser(jnp.zeros(size), jnp.ones(size), jnp.array(1e-4, jnp.float32))


def normalise(normaliser: Normaliser, x: Float[Array, "*batch o"]) -> Float[Array, "*batch o"]:
    """Standardised `x`, clipped to ±`OBSERVATION_CLIP`."""
    # A constant input has variance 0: the floor keeps it at 0 instead of blowing it up.
    mean = jnp.broadcast_to(normaliser.mean, x.shape)
    scale = jnp.broadcast_to(jnp.sqrt(normaliser.variance + 1e-6), x.shape)
    return jnp.clip((x - mean) / scale, -OBSERVATION_CLIP, OBSERVATION_CLIP)


def update_normaliser(normaliser: Normaliser, x: Float[Array, "*batch o"]) -> Normaliser:
    """Merges a batch into the running moments (Chan et al., parallel variance)."""
    rows = x.reshape(-1, x.shape[-1])
    count = jnp.asarray(rows.shape[0], jnp.float32)
    mean, variance = rows.mean(axis=0), rows.var(axis=0)
    total = normaliser.count + count
    shift = mean - normaliser.mean
    merged = (
        normaliser.variance * normaliser.count
        + variance * count
        + shift**2 * normaliser.count * count / total
    ) / total
    return Normaliser(normaliser.mean + shift * count / total, merged, total)

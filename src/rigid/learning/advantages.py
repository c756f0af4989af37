"""Advantages: how much better an action was than the critic expected, and in which unit.

T denotes steps, N episodes. Episodes of different aims, such as different λ, stand in equal blocks
along N, each of which has a scale of its own.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float


def advantages(
    reward: Float[Array, "T N"],
    value: Float[Array, "T N"],
    *,
    gamma: float,
    gae_lambda: float,
    weight: Float[Array, "T N"] | None = None,
) -> Float[Array, "T N"]:
    """Generalised advantage estimates; the value after the last step is 0.

    δₜ = rₜ + γ V(sₜ₊₁) - V(sₜ),  Aₜ = Σₖ (γλ)ᵏ δₜ₊ₖ   (Schulman et al., 2016, Eq. 16)

    Args:
        reward: rₜ.
        value: V(sₜ).
        gamma: Discount γ.
        gae_lambda: λ; 0 trusts the critic, 1 the returns.
        weight: 0 from the step on at which physics ran away, where δ is 0: the value of the last
            sound state stands for the rest of the episode.
    """
    next_value = jnp.concatenate([value[1:], jnp.zeros_like(value[:1])])
    delta = reward + gamma * next_value - value
    if weight is not None:
        delta = jnp.where(weight > 0, delta, 0.0)

    def back(carry: Array, step: Array) -> tuple[Array, Array]:
        total = step + gamma * gae_lambda * carry
        return total, total

    _, result = jax.lax.scan(back, jnp.zeros_like(delta[0]), delta, reverse=True)
    return result


def standardised(
    gain: Float[Array, "T N"], weight: Float[Array, "T N"], blocks: int = 1
) -> Float[Array, "T N"]:
    """Advantages with mean 0 and deviation 1 in each of `blocks` equal blocks of episodes.

    Args:
        gain: Advantages.
        weight: 0 for steps that do not count.
        blocks: Must divide N.
    """
    parts, weights = _in_blocks(gain, blocks), _in_blocks(weight, blocks)
    mean, deviation = _moments(parts, weights)
    return ((parts - mean) / deviation).reshape(gain.shape)


def signal_share(
    gain: Float[Array, "T N"], weight: Float[Array, "T N"], floor: float, blocks: int = 1
) -> tuple[Float[Array, "T N"], Float[Array, ""]]:
    """How loud each block's advantages are, for `PPOSettings.signal_floor`.

    Returns:
        Each step's factor, 1 in the loudest block; and that block's deviation over the floor, at
        most 1. Both are 1 where `floor` is 0.
    """
    if floor <= 0:
        return jnp.ones_like(gain), jnp.ones(())
    _, deviation = _moments(_in_blocks(gain, blocks), _in_blocks(weight, blocks))
    share = jnp.minimum(deviation / floor, 1.0)
    strongest = share.max()
    each = jnp.broadcast_to(share / strongest, (gain.shape[0], blocks, gain.shape[1] // blocks))
    return each.reshape(gain.shape), strongest


def _in_blocks(x: Float[Array, "T N"], blocks: int) -> Float[Array, "T B n"]:
    return x.reshape(x.shape[0], blocks, -1)


def _moments(
    parts: Float[Array, "T B n"], weight: Float[Array, "T B n"]
) -> tuple[Float[Array, "1 B 1"], Float[Array, "1 B 1"]]:
    """Mean and deviation of each block."""
    total = jnp.maximum(weight.sum(axis=(0, 2), keepdims=True), 1.0)
    mean = (parts * weight).sum(axis=(0, 2), keepdims=True) / total
    variance = ((parts - mean) ** 2 * weight).sum(axis=(0, 2), keepdims=True) / total
    return mean, jnp.sqrt(variance + 1e-8)

"""Least-squares discriminator between canonical and adversarial motion (paper, Eq. 2).

    D = argmin  w_a E_adversary[(D - 1)²] + w_c E_canonical[(D + 1)²] + g E_canonical[|∇D|²]

The paper prints `(exp{D + 1)²`; the braces are a slip, and plain LS-GAN (Mao et al., 2017) is
meant. Stabilisers of the paper's appendix 'Improving GAN training': annealed noise per feature,
gradient penalty, and class weights. With weights κ = w_c / w_a the optimum is

    D* = (q - κ p) / (q + κ p),   p canonical, q adversary,

so that D < 0 exactly where q < κ p.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import jax
import jax.numpy as jnp
import optax
from jaxtyping import Array, Float, PRNGKeyArray

from rigid.policies.networks import MLP, apply_mlp, init_mlp


@dataclass(frozen=True, kw_only=True)
class DiscriminatorSettings:
    """How the discriminator of one adversary is built and trained."""

    hidden: tuple[int, ...] = (64, 64)
    """Ours: the paper gives no size."""
    canonical_weight: float = 4.0
    adversary_weight: float = 1.0
    """Paper, appendix 'Improving GAN training'."""
    gradient_penalty: float = 0.3
    """Paper, same place; on standardised inputs."""
    noise: float = 0.3
    """Standard deviation of the instance noise at the start, in canonical standard deviations.
    The paper starts at 10, which hides the data for most of its 120 iterations. Ours."""
    noise_decay: float = 0.98
    """Per iteration (paper)."""
    noise_floor: float = 0.05
    """Ours: without a floor the discriminator separates two finite samples perfectly."""
    learning_rate: float = 1e-3
    steps: int = 30
    """Gradient steps after each policy step. The paper takes one, of unstated size. Ours."""
    weight_decay: float = 1e-4
    """AMP's (Peng et al., 2021)."""
    minibatch: int = 512
    replay_share: float = 0.25
    """Share of adversary samples that come from the last `replay_iterations` iterations (ours)."""
    replay_iterations: int = 20


class Discriminator(NamedTuple):
    """A discriminator in training."""

    network: MLP
    optimiser: optax.OptState


class DiscriminatorHealth(NamedTuple):
    """Means over one iteration's gradient steps."""

    loss: Float[Array, ""]
    score_canonical: Float[Array, ""]
    score_adversary: Float[Array, ""]
    accuracy_canonical: Float[Array, ""]
    accuracy_adversary: Float[Array, ""]


Penalty = Literal["amp", "paper_d2"]

PENALTIES: dict[str, Callable[[Array], Array]] = {
    # 0 on canonical motion, 1 where the discriminator is sure of an adversary; no upper clip, so
    # that a confident discriminator still has a slope (ours, after AMP, Peng et al. 2021).
    "amp": lambda score: 0.25 * jnp.maximum(score + 1, 0.0) ** 2,
    # As printed under Eq. 2. It pulls scores to 0, the decision boundary, not to canonical.
    "paper_d2": lambda score: score**2,
}


def _optimiser(settings: DiscriminatorSettings) -> optax.GradientTransformation:
    return optax.adamw(settings.learning_rate, weight_decay=settings.weight_decay)


def init_discriminator(
    key: PRNGKeyArray, feature_size: int, settings: DiscriminatorSettings
) -> Discriminator:
    """A random discriminator over standardised features."""
    network = init_mlp(key, (feature_size, *settings.hidden, 1))
    return Discriminator(network, _optimiser(settings).init(network))


def score(network: MLP, features: Float[Array, "*batch f"]) -> Float[Array, "*batch"]:
    """Discriminator score of standardised features; low = canonical."""
    return apply_mlp(network, features)[..., 0]


def noise_level(iteration: Float[Array, ""], settings: DiscriminatorSettings) -> Float[Array, ""]:
    """Instance noise at an iteration, in canonical standard deviations."""
    annealed = settings.noise * settings.noise_decay**iteration
    return jnp.maximum(annealed, settings.noise_floor)


def discriminator_loss(
    network: MLP,
    canonical: Float[Array, "n f"],
    adversary: Float[Array, "m f"],
    settings: DiscriminatorSettings,
) -> tuple[Float[Array, ""], DiscriminatorHealth]:
    """Eq. 2 with class weights and a zero-centred gradient penalty on canonical samples."""
    low, high = score(network, canonical), score(network, adversary)
    slopes = jax.vmap(jax.grad(lambda x: score(network, x)))(canonical)
    loss = (
        settings.canonical_weight * ((low + 1) ** 2).mean()
        + settings.adversary_weight * ((high - 1) ** 2).mean()
        + settings.gradient_penalty * (slopes**2).sum(axis=-1).mean()
    )
    health = DiscriminatorHealth(
        loss, low.mean(), high.mean(), (low < 0).mean(), (high >= 0).mean()
    )
    return loss, health


def update_discriminator(
    discriminator: Discriminator,
    canonical: Float[Array, "n f"],
    current: Float[Array, "m f"],
    replay: Float[Array, "r f"],
    noise: Float[Array, ""],
    key: PRNGKeyArray,
    settings: DiscriminatorSettings,
) -> tuple[Discriminator, DiscriminatorHealth]:
    """Takes `settings.steps` gradient steps on minibatches with fresh instance noise.

    Args:
        discriminator: The discriminator before the steps.
        canonical: Standardised canonical features.
        current: Standardised features of the adversary's newest episodes.
        replay: Those of earlier iterations.
        noise: Standard deviation of the instance noise, same units.
        key: Consumed.
        settings: Static under `jit`.
    """
    old = int(settings.minibatch * settings.replay_share)
    optimiser = _optimiser(settings)

    def step(carry: Discriminator, step_key: Array) -> tuple[Discriminator, DiscriminatorHealth]:
        keys = jax.random.split(step_key, 5)
        new = _draw(keys[0], current, settings.minibatch - old)
        adversary = jnp.concatenate([new, _draw(keys[1], replay, old)])
        real = _draw(keys[2], canonical, settings.minibatch)
        adversary = adversary + noise * jax.random.normal(keys[3], adversary.shape)
        real = real + noise * jax.random.normal(keys[4], real.shape)
        gradient, health = jax.grad(discriminator_loss, has_aux=True)(
            carry.network, real, adversary, settings
        )
        updates, state = optimiser.update(gradient, carry.optimiser, carry.network)
        return Discriminator(optax.apply_updates(carry.network, updates), state), health

    discriminator, health = jax.lax.scan(step, discriminator, jax.random.split(key, settings.steps))
    return discriminator, jax.tree.map(jnp.mean, health)


def _draw(key: PRNGKeyArray, rows: Float[Array, "n f"], count: int) -> Float[Array, "b f"]:
    return rows[jax.random.randint(key, (count,), 0, rows.shape[0])]

"""Least-squares discriminator between canonical and adversarial motion (paper, Eq. 2).

    D = argmin  w_a E_adversary[(D - 1)²] + w_c E_canonical[(D + 1)²] + g E_canonical[|∇D|²]

The paper prints `(exp{D + 1)²`; the braces are a slip, and plain LS-GAN (Mao et al., 2017) is
meant. Stabilisers of the paper's appendix 'Improving GAN training': annealed noise per feature,
gradient penalty, and class weights. With weights κ = w_c / w_a the optimum is

    D* = (q - κ p) / (q + κ p),   p canonical, q adversary,

so that D < 0 exactly where q < κ p. The same machinery trains the paper's logistic discriminator
(appendix 'Proof on Discriminator and KL Divergence'), whose optimum is D* = log q / (κ p).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import jax
import jax.numpy as jnp
import optax
from jaxtyping import Array, Float, PRNGKeyArray

from rigid.naturalness.measure import Health
from rigid.policies.networks import MLP, apply_mlp, init_mlp

Network = Any
"""Parameters of a discriminator, a pytree; an MLP where one sample is one row of features."""
Score = Callable[[Network, Array], Array]
"""Scores of samples under a network, one for each sample or each of its steps."""


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


NOISE_BANK = 5
"""Minibatches of instance noise that the steps of one update share. Ours."""
PENALISED_SHARE = 4
"""The gradient penalty is taken over every fourth canonical sample of a minibatch: the same mean,
and a fifth less work. Ours."""


class Discriminator(NamedTuple):
    """A discriminator in training."""

    network: Network
    optimiser: optax.OptState


Penalty = Literal["amp", "paper_d2"]

PENALTIES: dict[str, Callable[[Array], Array]] = {
    # 0 on canonical motion, 1 where the discriminator is sure of an adversary; no upper clip, so
    # that a confident discriminator still has a slope (ours, after AMP, Peng et al. 2021).
    "amp": lambda score: 0.25 * jnp.maximum(score + 1, 0.0) ** 2,
    # As printed under Eq. 2. It pulls scores to 0, the decision boundary, not to canonical.
    "paper_d2": lambda score: score**2,
}

Loss = Literal["least_squares", "logistic"]

LOSSES: dict[str, tuple[Callable[[Array], Array], Callable[[Array], Array]]] = {
    # What a score costs on canonical motion, and on an adversary's.
    "least_squares": (lambda score: (score + 1) ** 2, lambda score: (score - 1) ** 2),
    "logistic": (jax.nn.softplus, lambda score: jax.nn.softplus(-score)),
}


def _optimiser(settings: DiscriminatorSettings) -> optax.GradientTransformation:
    return optax.adamw(settings.learning_rate, weight_decay=settings.weight_decay)


def init_discriminator(
    key: PRNGKeyArray, feature_size: int, settings: DiscriminatorSettings
) -> Discriminator:
    """A random discriminator over standardised features."""
    return with_optimiser(init_mlp(key, (feature_size, *settings.hidden, 1)), settings)


def with_optimiser(network: Network, settings: DiscriminatorSettings) -> Discriminator:
    """A network that has not been trained yet."""
    return Discriminator(network, _optimiser(settings).init(network))


def score(network: MLP, features: Float[Array, "*batch f"]) -> Float[Array, "*batch"]:
    """Discriminator score of standardised features; low = canonical."""
    return apply_mlp(network, features)[..., 0]


def noise_level(iteration: Float[Array, ""], settings: DiscriminatorSettings) -> Float[Array, ""]:
    """Instance noise at an iteration, in canonical standard deviations."""
    annealed = settings.noise * settings.noise_decay**iteration
    return jnp.maximum(annealed, settings.noise_floor)


def discriminator_loss(
    network: Network,
    canonical: Float[Array, "n *sample"],
    adversary: Float[Array, "m *sample"],
    settings: DiscriminatorSettings,
    *,
    judge: Score = score,
    loss: Loss = "least_squares",
) -> tuple[Float[Array, ""], Health]:
    """Eq. 2 with class weights and a zero-centred gradient penalty on canonical samples.

    A sample is whatever `judge` scores: a row of features, or steps of them.
    """
    low, high = judge(network, canonical), judge(network, adversary)
    slopes = jax.vmap(jax.grad(lambda x: judge(network, x).sum()))(canonical[::PENALISED_SHARE])
    of_canonical, of_adversary = LOSSES[loss]
    total = (
        settings.canonical_weight * of_canonical(low).mean()
        + settings.adversary_weight * of_adversary(high).mean()
        + settings.gradient_penalty * (slopes**2).sum(axis=-1).mean()
    )
    health = Health(total, low.mean(), high.mean(), (low < 0).mean(), (high >= 0).mean())
    return total, health


def update_discriminator(
    discriminator: Discriminator,
    canonical: Float[Array, "n *sample"],
    current: Float[Array, "m *sample"],
    replay: Float[Array, "r *sample"],
    noise: Float[Array, ""],
    key: PRNGKeyArray,
    settings: DiscriminatorSettings,
    *,
    judge: Score = score,
    loss: Loss = "least_squares",
) -> tuple[Discriminator, Health]:
    """Takes `settings.steps` gradient steps on minibatches with instance noise.

    The noise comes from `NOISE_BANK` minibatches of it, drawn once: each step takes the next of
    them, paired with other samples. Drawing it for each step took a quarter of the time.

    Args:
        discriminator: The discriminator before the steps.
        canonical: Standardised canonical features.
        current: Standardised features of the adversary's newest episodes.
        replay: Those of earlier iterations.
        noise: Standard deviation of the instance noise, same units.
        key: Consumed.
        settings: Static under `jit`.
        judge: Scores samples; by default one row of features each.
        loss: Least squares, or the logistic one of KL.
    """
    old = int(settings.minibatch * settings.replay_share)
    optimiser = _optimiser(settings)

    noise_key, key = jax.random.split(key)
    shape = (NOISE_BANK, 2, settings.minibatch, *canonical.shape[1:])
    bank = noise * jax.random.normal(noise_key, shape)

    def step(
        carry: Discriminator, number_and_key: tuple[Array, Array]
    ) -> tuple[Discriminator, Health]:
        number, step_key = number_and_key
        blur, keys = bank[number % NOISE_BANK], jax.random.split(step_key, 3)
        new = _draw(keys[0], current, settings.minibatch - old)
        adversary = jnp.concatenate([new, _draw(keys[1], replay, old)]) + blur[0]
        real = _draw(keys[2], canonical, settings.minibatch) + blur[1]
        gradient, health = jax.grad(discriminator_loss, has_aux=True)(
            carry.network, real, adversary, settings, judge=judge, loss=loss
        )
        updates, state = optimiser.update(gradient, carry.optimiser, carry.network)
        return Discriminator(optax.apply_updates(carry.network, updates), state), health

    numbered = jnp.arange(settings.steps), jax.random.split(key, settings.steps)
    discriminator, health = jax.lax.scan(step, discriminator, numbered)
    return discriminator, jax.tree.map(jnp.mean, health)


def _draw(
    key: PRNGKeyArray, rows: Float[Array, "n *sample"], count: int
) -> Float[Array, "b *sample"]:
    return rows[jax.random.randint(key, (count,), 0, rows.shape[0])]

"""A latent for how the human moves: the recurrent variational autoencoder of PALM.

The paper (appendix 'PALM', after He et al., 2022): a history of 4 timesteps, 4 layers, 24 hidden
units, 4 latents, to predict human motions. We read the 4 layers as one recurrent unit of 24 and a
linear layer to the latent for the encoder, one tanh layer of 24 and a linear one for the decoder.
He et al. predict the human's action from robot observations and human actions; an action cannot be
observed, so ours predicts how what the robot sees of the human moves, from its observations alone.

T denotes steps, N episodes, K the observations of a window, newest first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypedDict

import jax
import jax.numpy as jnp
import optax
from jaxtyping import Array, Float, PRNGKeyArray

from rigid.learning.motion import Motion
from rigid.policies.networks import (
    MLP,
    Layer,
    Normaliser,
    apply_mlp,
    init_gru,
    init_layer,
    init_mlp,
    init_normaliser,
    normalise,
    update_normaliser,
)
from rigid.policies.palm import MotionEncoder, encode, summary_of


@dataclass(frozen=True, kw_only=True)
class MotionSettings:
    """Size and training of the autoencoder."""

    memory: int = 4
    """Observations in the encoder's window (paper)."""
    hidden: int = 24
    """Width of the recurrent unit (paper) and of the decoder's layer (ours)."""
    latent: int = 4
    """Paper."""
    ahead: int = 1
    """Control steps from the newest observation to the predicted one (paper: next motion)."""
    kl_weight: float = 1e-3
    """β of the loss, against squared errors in standard deviations of the motion. Ours: with
    `builtin:vanilla` the latent carries 13 nats, at 0.01 4 nats, and at 0.1 it is empty."""
    learning_rate: float = 1e-3
    """Ours, as the next two."""
    epochs: int = 4
    minibatch: int = 960


class MotionVAE(NamedTuple):
    """An autoencoder of motion in training."""

    encoder: MotionEncoder
    log_variance: Layer
    """From the encoder's recurrent state to the spread of the latent."""
    decoder: MLP
    """From the latent and the newest observation to the standardised displacement."""
    displacement: Normaliser
    """Of what is predicted."""
    optimiser: optax.OptState


class MotionLosses(NamedTuple):
    """Means over the last epoch."""

    prediction: Float[Array, ""]
    """Half the squared error, summed over coordinates, in standard deviations."""
    divergence: Float[Array, ""]
    """KL divergence of the latent from the standard normal [nats]."""


class _Trainable(TypedDict):
    recurrent: Layer
    mean: Layer
    log_variance: Layer
    decoder: MLP


def init_vae(
    key: PRNGKeyArray, settings: MotionSettings, *, observation_size: int, shown: int
) -> MotionVAE:
    """A random autoencoder.

    Args:
        key: Consumed.
        settings: Sizes and learning rate.
        observation_size: Numbers in one observation.
        shown: How many of them show the human.
    """
    keys = jax.random.split(key, 4)
    hidden, latent = settings.hidden, settings.latent
    encoder = MotionEncoder(
        init_gru(keys[0], 2 * observation_size, hidden),
        init_layer(keys[1], hidden, latent),
        init_normaliser(observation_size),
        init_normaliser(observation_size),
    )
    log_variance = init_layer(keys[2], hidden, latent, scale=0.01)
    decoder = init_mlp(keys[3], (latent + observation_size, hidden, shown), last_scale=0.01)
    trainable = _trainable(encoder, log_variance, decoder)
    state = optax.adam(settings.learning_rate).init(trainable)
    return MotionVAE(encoder, log_variance, decoder, init_normaliser(shown), state)


def predict(vae: MotionVAE, windows: Float[Array, "*batch Ko"]) -> Float[Array, "*batch d"]:
    """The expected displacement, in the units of the observation."""
    standard = _decode(vae.decoder, vae.encoder, encode(vae.encoder, windows), windows)
    mean, scale = _spread(vae.displacement, standard)
    return mean + scale * standard


def motion_loss(
    trainable: _Trainable,
    encoder: MotionEncoder,
    batch: dict[str, Array],
    noise: Float[Array, "n z"],
    kl_weight: float,
) -> tuple[Float[Array, ""], MotionLosses]:
    """Negative evidence lower bound with β on the divergence (Higgins et al., 2017).

    ½ Σ_d (x̂_d - x_d)² + β · ½ Σ_z (μ² + σ² - 1 - log σ²), a weighted mean over examples.

    Args:
        trainable: What gradients move.
        encoder: Gives the moments of observations, which no gradient moves.
        batch: `windows`, standardised `displacement`, `weight`.
        noise: Standard normal, one row for each example.
        kl_weight: β.
    """
    encoder = encoder._replace(recurrent=trainable["recurrent"], mean=trainable["mean"])
    summary = summary_of(encoder, batch["windows"])
    mean = apply_mlp([encoder.mean], summary)
    log_variance = apply_mlp([trainable["log_variance"]], summary)
    latent = mean + jnp.exp(0.5 * log_variance) * noise
    predicted = _decode(trainable["decoder"], encoder, latent, batch["windows"])
    error = 0.5 * ((predicted - batch["displacement"]) ** 2).sum(axis=-1)
    divergence = 0.5 * (mean**2 + jnp.exp(log_variance) - 1 - log_variance).sum(axis=-1)
    weight = batch["weight"] / jnp.maximum(batch["weight"].sum(), 1.0)
    losses = MotionLosses((error * weight).sum(), (divergence * weight).sum())
    return losses.prediction + kl_weight * losses.divergence, losses


def update_vae(
    vae: MotionVAE, motion: Motion, key: PRNGKeyArray, settings: MotionSettings
) -> tuple[MotionVAE, MotionLosses]:
    """A few epochs on one set of examples; `settings` must be static under `jit`.

    The running moments take the examples in first: unlike a policy, nothing acted on the old ones.
    """
    flat = {name: x.reshape(-1, *x.shape[2:]) for name, x in motion._asdict().items()}
    size = vae.encoder.normaliser.mean.shape[0]
    newest, before = flat["windows"][:, :size], flat["windows"][:, size : 2 * size]
    encoder = vae.encoder._replace(
        normaliser=update_normaliser(vae.encoder.normaliser, newest),
        change=update_normaliser(vae.encoder.change, newest - before),
    )
    displacement = update_normaliser(vae.displacement, flat["displacement"])
    mean, scale = _spread(displacement, flat["displacement"])
    flat["displacement"] = (flat["displacement"] - mean) / scale
    count = flat["weight"].shape[0]
    batches = max(count // settings.minibatch, 1)
    rows = count // batches
    order_key, noise_key = jax.random.split(key)
    orders = jax.vmap(lambda k: jax.random.permutation(k, count)[: batches * rows])(
        jax.random.split(order_key, settings.epochs)
    ).reshape(settings.epochs * batches, rows)
    noise = jax.random.normal(noise_key, (*orders.shape, settings.latent))
    optimiser = optax.adam(settings.learning_rate)

    def step(
        carry: tuple[_Trainable, optax.OptState], draw: tuple[Array, Array]
    ) -> tuple[tuple[_Trainable, optax.OptState], MotionLosses]:
        trainable, state = carry
        batch = {name: x[draw[0]] for name, x in flat.items()}
        gradient, losses = jax.grad(motion_loss, has_aux=True)(
            trainable, encoder, batch, draw[1], settings.kl_weight
        )
        updates, state = optimiser.update(gradient, state, trainable)
        return (optax.apply_updates(trainable, updates), state), losses

    start = _trainable(vae.encoder, vae.log_variance, vae.decoder)
    (found, state), losses = jax.lax.scan(step, (start, vae.optimiser), (orders, noise))
    encoder = encoder._replace(recurrent=found["recurrent"], mean=found["mean"])
    new = MotionVAE(encoder, found["log_variance"], found["decoder"], displacement, state)
    return new, jax.tree.map(lambda x: x[-batches:].mean(), losses)


def _trainable(encoder: MotionEncoder, log_variance: Layer, decoder: MLP) -> _Trainable:
    return {
        "recurrent": encoder.recurrent,
        "mean": encoder.mean,
        "log_variance": log_variance,
        "decoder": decoder,
    }


def _spread(
    moments: Normaliser, like: Float[Array, "*batch d"]
) -> tuple[Float[Array, "*batch d"], Float[Array, "*batch d"]]:
    """Mean and standard deviation, without the floor of `normalise`: millimetres matter here."""
    scale = jnp.sqrt(moments.variance) + 1e-6  # A coordinate that never moves must not divide by 0.
    return jnp.broadcast_to(moments.mean, like.shape), jnp.broadcast_to(scale, like.shape)


def _decode(
    decoder: MLP,
    encoder: MotionEncoder,
    latent: Float[Array, "*batch z"],
    windows: Float[Array, "*batch Ko"],
) -> Float[Array, "*batch d"]:
    size = encoder.normaliser.mean.shape[0]
    seen = normalise(encoder.normaliser, windows[..., :size])
    return apply_mlp(decoder, jnp.concatenate([latent, seen], axis=-1))

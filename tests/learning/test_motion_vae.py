"""The autoencoder of motion on a walker whose direction only history tells."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.learning.motion import constant_velocity, motion_of, root_mean_square
from rigid.learning.motion_vae import (
    MotionSettings,
    init_vae,
    motion_loss,
    predict,
    update_vae,
)
from rigid.policies.palm import encode

SETTINGS = MotionSettings(hidden=8, latent=2, learning_rate=1e-2, minibatch=256)
_update = jax.jit(update_vae, static_argnames="settings")
_loss = jax.jit(motion_loss, static_argnums=4)
_predict = jax.jit(predict)


def walks(seed, *, unit=1.0):
    """Walkers that start anywhere and go one way, +1 or -1 a step, seen through noise of 0.5.

    The newest place says nothing about the direction, a single difference little.
    """
    rng = np.random.default_rng(seed)
    way = rng.choice([-1.0, 1.0], 200)
    place = rng.uniform(-100, 100, 200) + np.arange(1, 13)[:, None] * way
    seen = place + 0.5 * rng.standard_normal(place.shape)
    return (unit * seen[..., None]).astype(np.float32), way


def examples(seed, **unit):
    seen, way = walks(seed, **unit)
    weight = np.ones(seen.shape[:2], np.float32)
    return motion_of(seen, weight, [0], memory=SETTINGS.memory, ahead=SETTINGS.ahead), way


def learned(**unit):
    vae = init_vae(jax.random.key(0), SETTINGS, observation_size=1, shown=1)
    for number in range(60):
        motion, _ = examples(number, **unit)
        vae, _ = _update(vae, motion, jax.random.key(number), settings=SETTINGS)
    return vae


@pytest.fixture(scope="module")
def vae():
    return learned()


def test_prediction_beats_constant_velocity_on_held_out_motion(vae):
    motion, _ = examples(1000)
    steady = constant_velocity(motion.windows, [0], memory=4, ahead=1)
    mine = root_mean_square(np.asarray(_predict(vae, motion.windows)), motion)
    assert mine < 0.6 * root_mean_square(steady, motion)


def test_the_latent_tells_apart_what_only_history_tells_apart(vae):
    motion, way = examples(1000)
    latent = np.asarray(encode(vae.encoder, jnp.asarray(motion.windows[-1])))
    between = latent[way > 0].mean(axis=0) - latent[way < 0].mean(axis=0)
    side = (latent - latent.mean(axis=0)) @ between
    assert ((side > 0) == (way > 0)).mean() > 0.95


def test_displacements_are_predicted_in_the_units_of_the_observation(vae):
    """Small units included: the error shrinks with them."""
    small = learned(unit=1e-3)
    motion, _ = examples(1000)
    tiny = examples(1000, unit=1e-3)[0]
    mine = root_mean_square(np.asarray(_predict(vae, motion.windows)), motion)
    theirs = root_mean_square(np.asarray(_predict(small, tiny.windows)), tiny)
    assert theirs == pytest.approx(1e-3 * mine, rel=0.2)


def loss_with(vae, *, mean, log_variance):
    """The loss where the latent has the given moments, and every prediction is 0.

    The first example moves by 3 standard deviations, the second weighs nothing.
    """
    parts = {**vae.encoder._asdict(), **vae._asdict()}
    names = ("recurrent", "mean", "log_variance", "decoder")
    silent = {name: jax.tree.map(jnp.zeros_like, parts[name]) for name in names}
    silent["mean"]["b"] = jnp.full(2, mean)
    silent["log_variance"]["b"] = jnp.full(2, log_variance)
    batch = {
        "windows": jnp.ones((2, 4)),
        "displacement": jnp.array([[3.0], [100.0]]),
        "weight": jnp.array([1.0, 0.0]),
    }
    loss, losses = _loss(silent, vae.encoder, batch, jnp.zeros((2, 2)), 0.5)
    return float(loss), float(losses.prediction), float(losses.divergence)


def test_the_loss_of_networks_that_say_nothing_is_the_motion_itself(vae):
    """Half the squared displacement; μ = 0 and σ = 1 do not diverge."""
    assert loss_with(vae, mean=0.0, log_variance=0.0) == pytest.approx((4.5, 4.5, 0.0))


def test_the_divergence_is_that_of_two_gaussians_times_its_weight(vae):
    """μ = 2, σ² = e: ½ (4 + e - 1 - 1) for each of two latents; β is a half."""
    divergence = 2 + np.e
    expected = (4.5 + 0.5 * divergence, 4.5, divergence)
    assert loss_with(vae, mean=2.0, log_variance=1.0) == pytest.approx(expected)

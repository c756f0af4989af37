"""Networks and running moments against NumPy."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.policies.networks import (
    OBSERVATION_CLIP,
    Normaliser,
    apply_mlp,
    init_mlp,
    init_normaliser,
    normalise,
    update_normaliser,
)


def test_two_layers_by_hand():
    network = [
        {"w": jnp.array([[1.0, 0.0], [0.0, 2.0]]), "b": jnp.array([0.0, -1.0])},
        {"w": jnp.array([[3.0], [-1.0]]), "b": jnp.array([0.5])},
    ]
    expected = 3 * np.tanh(0.2) - np.tanh(2 * 0.4 - 1) + 0.5
    assert apply_mlp(network, jnp.array([0.2, 0.4])) == pytest.approx(expected)


def test_the_last_layer_is_linear():
    network = [{"w": jnp.array([[5.0]]), "b": jnp.array([1.0])}]
    assert apply_mlp(network, jnp.array([20.0])) == 101.0


def test_every_row_of_a_batch_is_its_own_sample():
    network = init_mlp(jax.random.key(0), (3, 5, 2))
    rows = jax.random.normal(jax.random.key(1), (2, 4, 3))
    batched = apply_mlp(network, rows)
    assert batched.shape == (2, 4, 2)
    np.testing.assert_allclose(batched[1, 2], apply_mlp(network, rows[1, 2]), rtol=1e-6)


@pytest.mark.parametrize(
    ("layer", "gain"), [pytest.param(0, 2**0.5, id="hidden"), pytest.param(1, 0.01, id="last")]
)
def test_layers_start_orthogonal_with_their_gain_and_no_bias(layer, gain):
    network = init_mlp(jax.random.key(0), (6, 4, 2), last_scale=0.01)
    weights = np.asarray(network[layer]["w"])
    np.testing.assert_allclose(weights.T @ weights, gain**2 * np.eye(weights.shape[1]), atol=1e-6)
    assert not network[layer]["b"].any()


def test_a_fresh_normaliser_changes_nothing():
    x = jnp.array([[-3.0, 0.0, 7.0]])
    np.testing.assert_allclose(normalise(init_normaliser(3), x), x, rtol=1e-6)


def test_merged_moments_are_those_of_all_rows_together():
    rng = np.random.default_rng(0)
    batches = [
        (rng.normal(mean, std, size=shape)).astype(np.float32)
        for mean, std, shape in [(1, 2, (40, 3)), (-4, 0.1, (5, 3)), (0.5, 3, (7, 9, 3))]
    ]
    moments = init_normaliser(3)
    for batch in batches:
        moments = update_normaliser(moments, jnp.asarray(batch))
    rows = np.concatenate([batch.reshape(-1, 3) for batch in batches])
    np.testing.assert_allclose(moments.mean, rows.mean(axis=0), rtol=1e-4)
    np.testing.assert_allclose(moments.variance, rows.var(axis=0), rtol=1e-4)
    assert moments.count == pytest.approx(len(rows))


def test_normalised_rows_have_mean_0_and_deviation_1():
    rows = jnp.asarray(np.random.default_rng(0).normal(5, 3, size=(500, 2)), jnp.float32)
    scaled = normalise(update_normaliser(init_normaliser(2), rows), rows)
    np.testing.assert_allclose(scaled.mean(axis=0), 0, atol=1e-5)
    np.testing.assert_allclose(scaled.std(axis=0), 1, atol=1e-4)


def test_a_constant_observation_becomes_0():
    constant = Normaliser(jnp.array([4.0]), jnp.array([0.0]), jnp.array(100.0))
    assert normalise(constant, jnp.array([[4.0]])) == 0.0


def test_outliers_are_clipped():
    x = jnp.array([[1e6, -1e6]])
    np.testing.assert_array_equal(
        normalise(init_normaliser(2), x), [[OBSERVATION_CLIP, -OBSERVATION_CLIP]]
    )

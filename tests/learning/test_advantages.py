"""Generalised advantages against tables worked out by hand."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest

from rigid.learning.advantages import advantages, signal_share, standardised


def column(*values):
    return jnp.array(values, jnp.float32)[:, None]


REWARD, VALUE = column(1.0, 0.0, 2.0), column(0.5, 1.0, 4.0)


@pytest.mark.parametrize(
    ("gamma", "gae_lambda", "expected"),
    [
        # δ = (1 + ½·1 - ½, 0 + ½·4 - 1, 2 + ½·0 - 4) = (1, 1, -2), and γλ = ¼.
        pytest.param(0.5, 0.5, (1 + 0.25 * 0.5, 1 - 0.25 * 2, -2), id="half-half"),
        # δ = (1½, 3, -2), and γλ = ½.
        pytest.param(1.0, 0.5, (1.5 + 0.5 * 2, 3 - 0.5 * 2, -2), id="no-discount"),
        pytest.param(0.5, 0.0, (1, 1, -2), id="one-step"),
        pytest.param(0.0, 0.9, (0.5, -1, -2), id="blind-to-the-future"),
    ],
)
def test_a_table_by_hand(gamma, gae_lambda, expected):
    found = advantages(REWARD, VALUE, gamma=gamma, gae_lambda=gae_lambda)
    np.testing.assert_allclose(found[:, 0], expected, rtol=1e-6)


def test_with_lambda_1_it_is_the_return_minus_the_value():
    rng = np.random.default_rng(0)
    reward, value = rng.standard_normal((2, 7, 4)).astype(np.float32)
    discount = 0.9 ** np.arange(7)[:, None]
    returns = np.stack([(reward[t:] * discount[: 7 - t]).sum(axis=0) for t in range(7)])
    found = advantages(jnp.asarray(reward), jnp.asarray(value), gamma=0.9, gae_lambda=1.0)
    np.testing.assert_allclose(found, returns - value, rtol=1e-5, atol=1e-5)


def test_the_value_after_the_last_step_is_0():
    found = advantages(column(0.0, 3.0), column(0.0, 1.0), gamma=0.9, gae_lambda=0.95)
    assert found[-1, 0] == 2.0


def test_episodes_do_not_mix():
    reward = jnp.concatenate([REWARD, 100 * REWARD], axis=1)
    value = jnp.concatenate([VALUE, VALUE], axis=1)
    both = advantages(reward, value, gamma=0.5, gae_lambda=0.5)
    alone = advantages(REWARD, VALUE, gamma=0.5, gae_lambda=0.5)
    np.testing.assert_array_equal(both[:, :1], alone)


def test_what_follows_a_fault_does_not_reach_back():
    """The last sound step is worth its reward and the value of the state it led to."""
    reward, value = column(1.0, 9e9, 9e9), column(0.5, 1.0, 9e9)
    weight = column(1.0, 0.0, 0.0)
    found = advantages(reward, value, gamma=0.5, gae_lambda=0.5, weight=weight)
    np.testing.assert_array_equal(found[:, 0], [1 + 0.5 * 1 - 0.5, 0.0, 0.0])


def test_each_block_is_standardised_on_its_own():
    gain = jnp.array([[1.0, 3.0, 10.0, 30.0]])
    found = standardised(gain, jnp.ones((1, 4)), blocks=2)
    np.testing.assert_allclose(found, [[-1, 1, -1, 1]], rtol=1e-5)


def test_a_block_with_a_weak_signal_counts_for_less_than_the_loudest():
    gain = jnp.array([[-0.1, 0.1, -0.2, 0.2]])
    share, strongest = signal_share(gain, jnp.ones((1, 4)), 0.4, blocks=2)
    np.testing.assert_allclose(share, [[0.5, 0.5, 1, 1]], rtol=1e-3)
    assert float(strongest) == pytest.approx(0.5, rel=1e-3)


def test_above_the_floor_all_blocks_count_alike():
    gain = jnp.array([[-1.0, 1.0, -20.0, 20.0]])
    share, strongest = signal_share(gain, jnp.ones((1, 4)), 0.4, blocks=2)
    assert share.tolist() == [[1, 1, 1, 1]]
    assert float(strongest) == 1


def test_without_a_floor_every_signal_counts_in_full():
    share, strongest = signal_share(jnp.full((1, 2), 1e-6), jnp.ones((1, 2)), 0.0)
    assert (share.tolist(), float(strongest)) == ([[1, 1]], 1)

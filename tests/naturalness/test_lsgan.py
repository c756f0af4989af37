"""The discriminator: its loss by hand, its optimum on a task with a closed form, its penalties."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.naturalness.lsgan import (
    PENALTIES,
    DiscriminatorSettings,
    discriminator_loss,
    init_discriminator,
    noise_level,
    score,
    update_discriminator,
)
from tests.naturalness.offset_catch import best_score, boundary, offsets

SHIFT = 1.5
LINE = [{"w": jnp.array([[2.0]]), "b": jnp.array([0.5])}]  # D(x) = 2 x + ½.
FLAT = [{"w": jnp.array([[0.0]]), "b": jnp.array([0.5])}]
CANONICAL, ADVERSARY = jnp.array([[0.0], [1.0]]), jnp.array([[-1.0], [1.0]])

_train = jax.jit(update_discriminator, static_argnames="settings")


def trained(kappa):
    """The scoring network after a long training on offset catch, without noise or penalty."""
    settings = DiscriminatorSettings(
        hidden=(32,),
        canonical_weight=kappa,
        gradient_penalty=0.0,
        learning_rate=3e-3,
        steps=1000,
        minibatch=1024,
    )
    canonical, rows = jnp.asarray(offsets(0, 20_000, 0)), jnp.asarray(offsets(SHIFT, 20_000, 1))
    start = init_discriminator(jax.random.key(0), 1, settings)
    silent = jnp.zeros(())
    return _train(start, canonical, rows, rows, silent, jax.random.key(1), settings=settings)


def one_step(canonical, current, replay, noise):
    """What a single gradient step saw with the linear discriminator, on 8 rows of each value."""
    settings = DiscriminatorSettings(hidden=(), steps=1, minibatch=4096, replay_share=0.25)
    start = init_discriminator(jax.random.key(0), 1, settings)._replace(network=LINE)
    rows = [jnp.full((8, 1), value) for value in (canonical, current, replay)]
    return _train(start, *rows, jnp.asarray(noise), jax.random.key(1), settings=settings)[1]


@pytest.fixture(scope="module", params=[1.0, 4.0], ids="kappa {:g}".format)
def offset_catch(request):
    discriminator, health = trained(request.param)
    return request.param, discriminator.network, health


def test_the_loss_by_hand():
    settings = DiscriminatorSettings(
        canonical_weight=4.0, adversary_weight=0.5, gradient_penalty=0.3
    )
    loss, health = discriminator_loss(LINE, CANONICAL, ADVERSARY, settings)
    canonical = (1.5**2 + 3.5**2) / 2  # Scores ½ and 2½ should be -1.
    adversary = (2.5**2 + 1.5**2) / 2  # Scores -1½ and 2½ should be +1.
    assert loss == pytest.approx(4 * canonical + 0.5 * adversary + 0.3 * 2**2)
    assert [float(x) for x in health] == pytest.approx([float(loss), 1.5, 0.5, 0.0, 0.5])


def test_a_flat_discriminator_pays_no_gradient_penalty():
    losses = [
        discriminator_loss(network, CANONICAL, ADVERSARY, DiscriminatorSettings(gradient_penalty=g))
        for network in (FLAT, LINE)
        for g in (0.0, 10.0)
    ]
    flat_free, flat, line_free, line = (float(loss) for loss, _ in losses)
    assert (flat, line) == pytest.approx((flat_free, line_free + 10 * 2**2))


def test_the_gradient_penalty_looks_at_canonical_rows_alone():
    """A step at 0, where the adversary is; canonical rows lie on the flat parts."""
    step = [
        {"w": jnp.array([[20.0]]), "b": jnp.zeros(1)},
        {"w": jnp.ones((1, 1)), "b": jnp.zeros(1)},
    ]
    free, paid = (
        discriminator_loss(
            step,
            jnp.array([[-2.0], [2.0]]),
            jnp.zeros((2, 1)),
            DiscriminatorSettings(gradient_penalty=g),
        )[0]
        for g in (0.0, 10.0)
    )
    assert free == paid


def test_canonical_scores_low_and_the_adversary_high(offset_catch):
    _, network, health = offset_catch
    scores = score(network, jnp.array([[-2.0], [4.0]]))
    assert scores[0] < -0.7
    assert scores[1] > 0.7
    assert health.score_canonical < health.score_adversary - 0.5


def test_training_reaches_the_optimal_score(offset_catch):
    kappa, network, _ = offset_catch
    x = np.array([-1.5, -0.5, 0.5, 1.0, 2.0, 3.0])
    found = score(network, jnp.asarray(x[:, None], jnp.float32))
    np.testing.assert_allclose(found, best_score(x, SHIFT, kappa), atol=0.12)


def test_the_class_weights_put_the_boundary_where_q_is_kappa_p(offset_catch):
    kappa, network, _ = offset_catch
    grid = jnp.linspace(-2, 4, 601)
    first_high = grid[jnp.argmax(score(network, grid[:, None]) >= 0)]
    assert first_high == pytest.approx(boundary(SHIFT, kappa), abs=0.1)


def test_noise_falls_by_its_decay_and_stops_at_the_floor():
    settings = DiscriminatorSettings(noise=0.4, noise_decay=0.5, noise_floor=0.05)
    levels = [float(noise_level(jnp.array(float(i)), settings)) for i in (0, 1, 2, 3, 4, 100)]
    assert levels == pytest.approx([0.4, 0.2, 0.1, 0.05, 0.05, 0.05])


def test_noise_blurs_both_classes():
    """Apart as they are, both look alike under noise that is much wider than their distance."""
    clear, blurred = (one_step(-3.0, 3.0, 3.0, noise) for noise in (0.0, 100.0))
    assert clear.accuracy_canonical == clear.accuracy_adversary == 1
    assert blurred.accuracy_canonical == pytest.approx(0.5, abs=0.05)
    assert blurred.accuracy_adversary == pytest.approx(0.5, abs=0.05)


def test_the_replay_fills_its_share_of_every_minibatch():
    """A quarter here: its rows lie at 10, today's at 0."""
    health = one_step(0.0, 0.0, 10.0, 0.0)
    assert health.score_adversary == pytest.approx(0.5 + 20 / 4)
    assert health.score_canonical == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("penalty", "at_canonical", "at_boundary", "at_adversary"),
    [("amp", 0.0, 0.25, 1.0), ("paper_d2", 1.0, 0.0, 1.0)],
)
def test_penalties_at_the_three_scores(penalty, at_canonical, at_boundary, at_adversary):
    values = PENALTIES[penalty](jnp.array([-1.0, 0.0, 1.0]))
    np.testing.assert_array_equal(values, [at_canonical, at_boundary, at_adversary])


def test_more_canonical_than_canonical_costs_nothing_and_no_score_is_too_high_to_fall():
    """Of the default: nothing to gain below -1, and still a slope above +1."""
    np.testing.assert_array_equal(PENALTIES["amp"](jnp.array([-3.0, 3.0])), [0.0, 4.0])

"""A measure that is told whom it judges: the inner one, at a code."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.naturalness.choice import measure_named
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.measure import Motion
from rigid.naturalness.told import Told, ToldState, with_code
from tests.learning.reach import goer

SETTINGS = DiscriminatorSettings(hidden=(8,), steps=40, minibatch=64, learning_rate=1e-2)
CANONICAL = jax.random.normal(jax.random.key(0), (6, 5, 2))
CODES = 2.0 * jnp.eye(2)
HUMAN = goer(1)
ITERATION = jnp.asarray(0, jnp.int32)


def motion(features):
    """Motion of which only the features matter."""
    steps, episodes, _ = features.shape
    nothing = jnp.zeros((steps, episodes, 1))
    return Motion(features, jnp.ones((steps, episodes)), nothing, nothing)


@pytest.fixture(scope="module")
def trained():
    """One discriminator, for an adversary that moves far off under code 0 and not under code 1."""
    inner = measure_named("lsgan", SETTINGS, "amp")
    natural = jnp.concatenate([with_code(CANONICAL, code) for code in CODES])
    strange = jnp.swapaxes(CANONICAL, 0, 1)
    both = [with_code(strange + 4.0 * (1 - index), code) for index, code in enumerate(CODES)]
    seen, state = (
        motion(jnp.concatenate(both, axis=1)),
        inner.start(jax.random.key(1), natural, HUMAN),
    )
    for number in range(10):
        keys = jax.random.split(jax.random.key(number), 2)
        state, _ = inner.update(state, natural, seen, HUMAN, ITERATION + number, keys)
    return Told(inner, 2), state


def test_a_code_stands_behind_the_features():
    found = with_code(jnp.ones((3, 2)), jnp.array([0.0, 1.0]))
    np.testing.assert_allclose(found, [[1, 1, 0, 1]] * 3)


def test_each_adversary_is_judged_by_its_own_code(trained):
    """The same motion, far off, is known to be the first one's and was never the second one's."""
    told, state = trained
    far = jnp.swapaxes(CANONICAL, 0, 1) + 4.0
    first, second = (told.score(ToldState(state, code), far).mean() for code in CODES)
    assert first > 0.5
    assert second < first - 0.3


def test_canonical_motion_is_canonical_under_every_code(trained):
    told, state = trained
    seen = jnp.swapaxes(CANONICAL, 0, 1)
    assert all(told.score(ToldState(state, code), seen).mean() < 0 for code in CODES)


def test_what_is_kept_scores_as_the_state_does(trained):
    told, state = trained
    seen, asked = jnp.swapaxes(CANONICAL, 0, 1), ToldState(state, CODES[0])
    kept = told.kept(asked)
    np.testing.assert_array_equal(told.score_kept(kept, seen), told.score(asked, seen))


def test_mmd_holds_rows_of_one_code_against_no_others():
    """An adversary pays for its own distance, whatever those of other codes do."""
    inner = measure_named("mmd", SETTINGS, "amp", code_size=2)
    natural = jnp.concatenate([with_code(CANONICAL, code) for code in CODES])
    still = jnp.swapaxes(CANONICAL, 0, 1)[::-1]

    def paid(shift):
        both = [with_code(still, CODES[0]), with_code(still + shift, CODES[1])]
        state = inner.start(jax.random.key(0), with_code(CANONICAL, CODES[0]), HUMAN)
        found = inner.penalty(state, natural, motion(jnp.concatenate(both, axis=1)), HUMAN)
        return found[:, :6], found[:, 6:]

    (mine, _), (mine_too, strange) = paid(0.0), paid(3.0)
    np.testing.assert_allclose(mine, mine_too, atol=1e-6)
    assert strange.mean() > mine.mean() + 0.1


@pytest.mark.parametrize("name", ["lsgan", "mmd"])
def test_a_told_measure_is_the_inner_one_on_features_with_the_code(name):
    inner = measure_named(name, SETTINGS, "amp", code_size=2)
    told, key, human = Told(inner, 2), jax.random.key(0), HUMAN
    state = told.start(key, CANONICAL, human)
    natural = with_code(CANONICAL, jnp.zeros(2))
    plain = inner.start(key, natural, human)
    seen = motion(jnp.swapaxes(CANONICAL, 0, 1) + 1.0)
    with_its_code = seen._replace(features=with_code(seen.features, jnp.zeros(2)))
    np.testing.assert_array_equal(
        told.penalty(state, CANONICAL, seen, human),
        inner.penalty(plain, natural, with_its_code, human),
    )
    assert float(told.unit(state, CANONICAL)) == float(inner.unit(plain, natural))

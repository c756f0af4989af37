"""Measures side by side: each does what it would do alone, whatever its neighbours see."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.naturalness.choice import measure_named
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.measure import Motion
from rigid.naturalness.side_by_side import SideBySide
from tests.learned_measures import WITH_SLOW
from tests.learning.reach import goer

SETTINGS = DiscriminatorSettings(hidden=(8,), steps=40, minibatch=64, learning_rate=1e-2)
CANONICAL = jax.random.normal(jax.random.key(0), (6, 5, 2))
HUMAN = goer(1)
ITERATION = jnp.asarray(0, jnp.int32)
KEYS = jax.random.split(jax.random.key(3), 2)
NEAR, FAR = (jnp.swapaxes(CANONICAL, 0, 1) + shift for shift in (0.1, 4.0))


def motions(*features):
    """One motion for each adversary, of which only features and actions matter."""
    seen = jnp.stack(features)
    nothing = jnp.zeros((*seen.shape[:3], HUMAN.normaliser.mean.size))
    return Motion(seen, jnp.ones(seen.shape[:3]), nothing, jnp.zeros((*seen.shape[:3], 1)))


def one(tree, index):
    return jax.tree.map(lambda leaf: leaf[index], tree)


def equal(found, expected):
    for mine, theirs in zip(*(jax.tree.leaves(tree) for tree in (found, expected)), strict=True):
        np.testing.assert_allclose(mine, theirs, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("name", WITH_SLOW)
def test_each_does_what_it_would_do_alone(name):
    inner = measure_named(name, SETTINGS, "amp")
    both, seen = SideBySide(inner, 2), motions(NEAR, FAR)
    states = both.start(jax.random.key(1), CANONICAL, HUMAN)
    units, paid = both.unit(states, CANONICAL), both.penalty(states, CANONICAL, seen, HUMAN)
    scores = both.score(states, seen.features)
    after, health = both.update(states, CANONICAL, seen, HUMAN, ITERATION, KEYS)
    for index in range(2):
        state = inner.start(jax.random.split(jax.random.key(1))[index], CANONICAL, HUMAN)
        mine = one(seen, index)
        equal(one(states, index), state)
        equal(units[index], inner.unit(state, CANONICAL))
        equal(paid[index], inner.penalty(state, CANONICAL, mine, HUMAN))
        equal(one(scores, index), inner.score(state, mine.features))
        keys = jnp.stack([jax.random.split(key)[index] for key in KEYS])
        equal(
            (one(after, index), one(health, index)),
            inner.update(state, CANONICAL, mine, HUMAN, ITERATION, keys),
        )


def test_a_neighbour_far_off_makes_nobody_suspicious():
    both = SideBySide(measure_named("lsgan", SETTINGS, "amp"), 2)

    def judged(neighbour):
        states = both.start(jax.random.key(1), CANONICAL, HUMAN)
        for number in range(5):
            keys = jax.random.split(jax.random.key(number), 2)
            states, _ = both.update(
                states, CANONICAL, motions(NEAR, neighbour), HUMAN, ITERATION + number, keys
            )
        return both.score(states, jnp.stack([NEAR, FAR]))

    beside_near, beside_far = judged(NEAR), judged(FAR)
    np.testing.assert_array_equal(beside_near[0], beside_far[0])
    assert beside_far[1].mean() > 0.5

"""Measures without a discriminator: lost episodes are as if nobody had played them."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.naturalness.kl import ExactKL
from rigid.naturalness.measure import Motion
from rigid.naturalness.mmd import MMD
from rigid.tasks.protocol import AgentSpec
from tests.toys import untrained

SOUND, EPISODES, STEPS = 6, 8, 10
HUMAN, OTHER = (untrained(AgentSpec(3, 2), seed=seed, std=0.5).parameters for seed in (0, 1))


def played() -> Motion:
    """The last two episodes are lost from the start, and nothing like the others."""
    rng = np.random.default_rng(0)
    weight = np.ones((STEPS, EPISODES))
    weight[:, SOUND:] = 0
    parts = [rng.standard_normal((STEPS, EPISODES, size)) for size in (2, 3, 2)]
    for rows in parts:
        rows[:, SOUND:] += 2
    features, observation, action = (jnp.asarray(rows, jnp.float32) for rows in parts)
    return Motion(features, jnp.asarray(weight, jnp.float32), observation, action)


@pytest.mark.parametrize("measure", [MMD(), ExactKL()], ids=lambda measure: type(measure).__name__)
def test_lost_episodes_are_as_if_they_had_not_been_played(measure):
    everything = played()
    sound = Motion(*(rows[:, :SOUND] for rows in everything))
    canonical = jnp.asarray(np.random.default_rng(1).standard_normal((5, STEPS, 2)), jnp.float32)
    state, keys = (
        measure.start(jax.random.key(0), canonical, HUMAN),
        jax.random.split(jax.random.key(1)),
    )

    penalties, losses = [], []
    for motion in (everything, sound):
        penalty = measure.penalty(state, canonical, motion, OTHER)
        penalties.append(penalty[:, :SOUND])
        health = measure.update(state, canonical, motion, OTHER, jnp.asarray(0), keys)[1]
        losses.append(float(health.loss))

    np.testing.assert_allclose(*penalties, rtol=1e-4, atol=1e-6)
    assert losses[0] == pytest.approx(losses[1], rel=1e-4)

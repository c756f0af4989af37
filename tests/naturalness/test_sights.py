"""What a discriminator learns from: nothing that a fault spoilt."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest

from rigid.naturalness.sights import Recurrent, Steps, Windows

CANONICAL = jnp.arange(12.0).reshape(2, 6, 1)  # Two episodes of six steps.
SEEN = 100 + jnp.arange(18.0).reshape(6, 3, 1)  # Six steps of three episodes,
WEIGHT = jnp.ones((6, 3)).at[4:, 1].set(0.0)  # the second of which runs away after four.


def test_canonical_steps_stand_in_for_those_after_a_fault_alone():
    units = np.asarray(Steps().units(SEEN, WEIGHT, CANONICAL)).reshape(6, 3)
    sound = np.asarray(WEIGHT) > 0
    np.testing.assert_array_equal(units[sound], np.asarray(SEEN)[..., 0][sound])
    assert set(units[~sound]) <= set(np.asarray(CANONICAL).ravel())


@pytest.mark.parametrize("sight", [Windows(length=3), Recurrent()], ids=str)
def test_where_the_past_is_seen_a_canonical_episode_stands_in_for_one_with_a_fault(sight):
    units = np.asarray(sight.units(SEEN, WEIGHT, CANONICAL))
    np.testing.assert_array_equal(units[[0, 2]], np.asarray(SEEN.swapaxes(0, 1))[[0, 2]])
    assert units[1].tolist() in np.asarray(CANONICAL).tolist()

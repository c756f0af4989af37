"""Standard errors of shares: an episode is one draw, however many steps it has."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.naturalness.rates import rate


def test_the_error_grows_when_the_steps_of_an_episode_agree():
    """Ten episodes of 100 steps: as ten throws of a coin, not as a thousand."""
    rng = np.random.default_rng(0)
    agreeing = np.repeat(np.arange(10)[:, None] % 2, 100, axis=1)
    loose = rng.permutation(agreeing.ravel()).reshape(10, 100)
    every = np.ones((10, 100), dtype=bool)
    assert rate(agreeing, every).se == pytest.approx(0.5 / 3)
    assert rate(loose, every).se < 0.03


def test_the_error_covers_the_truth_as_often_as_it_says():
    rng = np.random.default_rng(0)
    every = np.ones((40, 10), dtype=bool)
    hits = 0
    for _ in range(400):
        chance = rng.beta(2, 2, (40, 1))
        found = rate(rng.random((40, 10)) < chance, every)
        hits += abs(found.value - 0.5) < 1.96 * found.se
    assert 0.91 <= hits / 400 <= 0.98


def test_one_episode_has_no_error():
    assert rate(np.ones((1, 4)), np.ones((1, 4), dtype=bool)) == (1.0, None)

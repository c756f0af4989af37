"""Noise on canonical motion: its levels, its unit, and what never becomes noisy."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.naturalness.noise import NOISE_LEVELS, movement, under_noise

RNG = np.random.default_rng(0)
EPISODES = np.stack([
    RNG.normal(5, 3, (20, 500)), RNG.normal(0, 0.1, (20, 500)), RNG.integers(0, 2, (20, 500)),
], axis=-1)  # fmt: skip


def test_levels_rise_from_none_to_the_papers_ten():
    assert (NOISE_LEVELS[0], NOISE_LEVELS[-1]) == (0.0, 10.0)
    assert (np.diff(NOISE_LEVELS) > 0).all()


def test_each_feature_has_its_own_deviation_and_a_label_has_none():
    np.testing.assert_allclose(movement(EPISODES), [3, 0.1, 0], rtol=0.02)


@pytest.mark.parametrize("level", NOISE_LEVELS)
def test_noise_has_the_stated_size(level):
    noisy = under_noise(EPISODES, movement(EPISODES), np.random.default_rng(1), (level,))[0]
    found = (noisy - EPISODES).std(axis=(0, 1))
    np.testing.assert_allclose(found, level * np.array([3, 0.1, 0]), rtol=0.03, atol=1e-6)


def test_a_pose_drifts_along_one_line():
    noisy = under_noise(EPISODES, movement(EPISODES), np.random.default_rng(1), (0.0, 1.0, 3.0))
    np.testing.assert_array_equal(noisy[0], EPISODES.astype(np.float32))
    drift = noisy[1:] - EPISODES
    np.testing.assert_allclose(drift[1], 3 * drift[0], rtol=1e-4, atol=1e-4)

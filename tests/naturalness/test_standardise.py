"""The frozen scale of canonical data."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.naturalness.standardise import canonical_scale, standardise

RNG = np.random.default_rng(0)


def correlated(rows=4000):
    """Two joints that move together, one on its own, in their own units."""
    shared, own = RNG.standard_normal((2, rows))
    noise = RNG.standard_normal((rows, 3))
    return np.stack([100 * (shared + 0.3 * noise[:, 0]), shared + 0.3 * noise[:, 1], own], axis=1)


def test_canonical_rows_become_white():
    rows = correlated()
    scaled = standardise(canonical_scale(rows), rows)
    np.testing.assert_allclose(scaled.mean(axis=0), 0, atol=1e-3)
    np.testing.assert_allclose(np.cov(scaled, rowvar=False), np.eye(3), atol=1e-2)


def test_leaving_the_correlation_is_far_while_each_feature_alone_is_near():
    scale = canonical_scale(correlated())
    along, across = standardise(scale, np.array([[100.0, 1.0, 0.0], [100.0, -1.0, 0.0]]))
    assert np.linalg.norm(across) > 3 * np.linalg.norm(along)


def test_episodes_and_rows_give_the_same_scale():
    rows = correlated(60)
    by_episode = canonical_scale(rows.reshape(5, 12, 3))
    for found, expected in zip(by_episode, canonical_scale(rows), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_a_constant_feature_keeps_its_unit():
    rows = np.column_stack([RNG.standard_normal(500), np.full(500, 7.0)])
    scaled = standardise(canonical_scale(rows), np.array([[0.0, 7.0], [0.0, 9.5]]))
    assert scaled[:, 1] == pytest.approx([0.0, 2.5])
    assert scaled[0, 0] == pytest.approx(scaled[1, 0])


def test_directions_that_hardly_vary_are_not_stretched_without_bound():
    shared = RNG.standard_normal(2000)
    rows = np.stack([shared, shared], axis=1)  # No canonical row ever leaves the diagonal.
    off = standardise(canonical_scale(rows), np.array([[0.01, -0.01]]))
    assert np.linalg.norm(off) < 0.2


def test_the_ruler_does_not_move_with_what_it_measures():
    scale = canonical_scale(correlated())
    before = [part.copy() for part in scale]
    alone = standardise(scale, np.array([[1.0, 1.0, 1.0]]))
    crowd = standardise(scale, np.array([[1.0, 1.0, 1.0], [1e6, -1e6, 1e6]]))
    np.testing.assert_allclose(crowd[:1], alone, rtol=1e-6)
    for now, then in zip(scale, before, strict=True):
        np.testing.assert_array_equal(now, then)


def test_units_do_not_matter():
    rows, units = correlated(300), np.array([1e3, 1e-3, 5.0])
    one = standardise(canonical_scale(rows), rows)
    other = standardise(canonical_scale(rows * units), rows * units)
    np.testing.assert_allclose(one, other, atol=1e-2)

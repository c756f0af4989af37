"""Counting, and drawing from a finite population."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.coverage.covering import (
    as_if_unlimited,
    cover_of,
    error_of_results,
    with_replacement,
    without_replacement,
)
from benchmarks.coverage.ends import printed

EVERYWHERE = (-np.inf, np.inf)


def generator():
    return np.random.default_rng(11)


def test_the_error_of_a_cover_is_that_of_a_share():
    ends = np.array([[0.0] * 19 + [0.6], [1.0] * 20])
    assert cover_of(ends, 0.5).error == pytest.approx((0.95 * 0.05 / 20) ** 0.5)


def test_an_end_that_equals_the_truth_holds_it():
    assert cover_of(np.array([[0.5, 0.2], [0.7, 0.5]]), 0.5).cover == 1.0


def test_draws_without_replacement_name_nobody_twice():
    drawn = without_replacement(12, 5, 300, generator())
    assert drawn.shape == (5, 300)
    assert all(len(set(column)) == 5 for column in drawn.T.tolist())


def test_draws_without_replacement_name_everybody_equally_often():
    counts = np.bincount(without_replacement(8, 3, 8000, generator()).ravel(), minlength=8)
    np.testing.assert_allclose(counts, 3000, atol=200)


def test_a_draw_of_everybody_is_refused():
    with pytest.raises(ValueError, match=r"a draw of 4 needs a population of more, got 4"):
        without_replacement(4, 4, 1, generator())


def test_moved_means_vary_as_those_of_independent_draws():
    population = generator().normal(0.5, 0.1, size=20)
    truth, size = float(population.mean()), 8
    sample = population[without_replacement(20, size, 20_000, generator())]
    deviation = population.std(ddof=1) / size**0.5
    assert sample.mean(axis=0).std() == pytest.approx(deviation * (1 - size / 20) ** 0.5, rel=0.03)
    moved = as_if_unlimited(sample, truth, 20)
    assert moved.mean(axis=0).std() == pytest.approx(deviation, rel=0.03)
    np.testing.assert_allclose(moved.std(axis=0), sample.std(axis=0))


@pytest.mark.parametrize("size", [3, 8])
def test_both_ways_of_drawing_from_a_normal_population_cover_95_percent(size):
    population = generator().normal(0.5, 0.1, size=400)
    truth = float(population.mean())
    one = population[with_replacement(400, size, 20_000, generator())]
    other = population[without_replacement(400, size, 20_000, generator())]
    for values in (one, as_if_unlimited(other, truth, 400)):
        found = cover_of(printed(values, EVERYWHERE), truth)
        assert found.cover == pytest.approx(0.95, abs=0.01)


def test_more_results_make_a_cover_better_known():
    values = generator().beta(1, 9, size=400)
    few, many = (
        error_of_results(
            values[:count], 5, printed, (0.0, 1.0), redraws=60, draws=1000, rng=generator()
        )
        for count in (15, 400)
    )
    assert few > 2 * many

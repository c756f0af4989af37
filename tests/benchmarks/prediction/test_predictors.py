"""The numbers that might predict, as measured and from redrawn seeds."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.prediction.predictors import (
    HEADLINES,
    PREDICTORS,
    interval_of,
    numbers_of,
    redrawn,
)
from tests.benchmarks.prediction.samples import frontier

TWO_SEEDS = [(0, 0.92, 0.5, 0.2), (0, 0.1, 0.1, 0.8), (1, 0.96, 0.9, 0.4), (1, 0.1, 0.2, 0.6)]


def test_every_predictor_is_a_field_of_the_frontier():
    found = frontier(TWO_SEEDS)
    numbers = numbers_of(found)
    assert set(numbers) == set(PREDICTORS)
    assert numbers["worst_at_0.9"] == found["worst_at"]["0.9"] == pytest.approx(0.3)
    assert numbers["auc_paper_axis"] == found["auc_paper_axis"]
    assert numbers["canonical"] == 0.05


def test_a_number_that_the_search_did_not_have_is_undefined():
    assert np.isnan(numbers_of({**frontier(TWO_SEEDS), "auc_paper_axis": None})["auc_paper_axis"])


def test_redrawing_two_seeds_gives_each_alone_and_both():
    worst = redrawn(frontier(TWO_SEEDS), 50, np.random.default_rng(0))["worst_at_0.9"]
    assert set(worst.round(9)) == {0.2, 0.3, 0.4}


def test_a_redraw_of_all_seeds_is_the_measured_headline():
    found = frontier(TWO_SEEDS)
    again = redrawn(found, 50, np.random.default_rng(0))
    both = int(np.flatnonzero(np.isclose(again["worst_at_0.9"], 0.3))[0])
    assert {name: again[name][both] for name in HEADLINES} == pytest.approx(
        {name: numbers_of(found)[name] for name in HEADLINES}
    )


def test_pooled_numbers_are_redrawn_as_they_are_pooled():
    alone = [numbers_of(frontier(TWO_SEEDS[part]))["auc_paper_axis"]
             for part in (slice(2), slice(2, 4))]  # fmt: skip
    pooled = numbers_of(frontier(TWO_SEEDS))["auc_paper_axis"]
    again = redrawn(frontier(TWO_SEEDS), 50, np.random.default_rng(0))["auc_paper_axis"]
    assert sorted(set(again.tolist())) == pytest.approx(sorted([*alone, pooled]))


def test_the_baseline_has_no_seeds_to_redraw():
    assert set(redrawn(frontier(TWO_SEEDS), 5, np.random.default_rng(0))["canonical"]) == {0.05}


def test_intervals_are_those_of_the_frontier():
    found = frontier(TWO_SEEDS)
    assert interval_of(found, "worst_at_0.9") == tuple(found["worst_at_interval"]["0.9"])
    assert interval_of(found, "auc_natural") == tuple(found["auc_natural_interval"])


def test_one_seed_has_no_interval():
    assert interval_of(frontier(TWO_SEEDS[:2]), "auc") is None

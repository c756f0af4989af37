"""The headline numbers of several seeds, by hand."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigid.frontier.curve import area_under_frontier, hull_at
from rigid.frontier.statistics import (
    MeasuredPoint,
    interval_band,
    sound_points_by_seed,
    summarize_seeds,
    t_interval,
)

EVERYWHERE = (-math.inf, math.inf)
shares = st.floats(0.0, 1.0)


def generator() -> np.random.Generator:
    return np.random.default_rng(7)


def point(
    seed: int,
    naturalness: float,
    adversarialness: float,
    *,
    own: float | None = 0.5,
    faulted: float = 0.0,
) -> MeasuredPoint:
    return MeasuredPoint(
        id=f"s{seed}-{naturalness}",
        seed=seed,
        naturalness=naturalness,
        naturalness_own=own,
        adversarialness=adversarialness,
        faulted_share=faulted,
    )


# Two seeds whose every number is simple. Seed 0: sabotage, and half-way failure at .9.
# Seed 1: sabotage only. Canonical play costs 0 and .2.
SEED_0 = [point(0, 0.0, 1.0, own=0.2), point(0, 0.9, 0.5, own=0.4)]
SEED_1 = [point(1, 0.5, 1.0, own=0.6)]
ANCHORS = {0: 0.0, 1: 0.2}
HULL_0 = 0.9 * 0.75 + 0.1 * 0.25
HULL_1 = 0.5 + 0.5 * 0.6


def test_headline_numbers_are_means_of_per_seed_values():
    summary = summarize_seeds([*SEED_0, *SEED_1], ANCHORS, rng=generator())
    assert summary.auc_by_seed == pytest.approx({"0": HULL_0, "1": HULL_1})
    assert summary.auc == pytest.approx((HULL_0 + HULL_1) / 2)
    assert summary.worst_at == pytest.approx({"0.8": 0.35, "0.9": 0.35, "0.95": 0.1})
    assert summary.worst_at_by_seed["0.9"] == {"0": 0.5, "1": 0.2}
    natural_0 = ((0.5 + 0.05 / 0.9 + 0.5) / 2 + 0.25) / 2
    natural_1 = 0.2 + 0.8 * 0.2
    assert summary.auc_natural_by_seed == pytest.approx({"0": natural_0, "1": natural_1})
    assert summary.auc_natural == pytest.approx((natural_0 + natural_1) / 2)
    assert summary.auc_staircase == pytest.approx((0.9 * 0.5 + 0.5 + 0.5 * 0.2) / 2)
    assert summary.auc_linear == pytest.approx((HULL_0 + HULL_1) / 2)
    assert summary.auc_excess == pytest.approx((HULL_0 - 0.5 + HULL_1 - 0.6) / 2)


def test_staircase_and_linear_are_not_the_hull_by_another_name():
    below_the_line = [point(0, 0.2, 0.9), point(0, 0.5, 0.4), point(0, 0.9, 0.3)]
    summary = summarize_seeds(below_the_line, {0: 0.0}, rng=generator())
    assert summary.auc == pytest.approx(0.600 + 0.015)
    assert summary.auc_linear == pytest.approx(0.515 + 0.015)
    assert summary.auc_staircase == pytest.approx(0.420)


def test_intervals_are_t_over_the_per_seed_values():
    summary = summarize_seeds([*SEED_0, *SEED_1], ANCHORS, rng=generator())
    assert summary.auc_interval == t_interval(list(summary.auc_by_seed.values()))
    assert summary.auc_natural_interval == t_interval(list(summary.auc_natural_by_seed.values()))
    assert summary.worst_at_interval["0.9"] == t_interval([0.5, 0.2])
    assert list(summary.worst_at_interval) == ["0.8", "0.9", "0.95"]
    assert summary.auc_interval_bca is None


def test_pooled_frontier_takes_all_seeds_and_the_mean_anchor():
    summary = summarize_seeds([*SEED_0, *SEED_1], ANCHORS, rng=generator())
    pooled = [(0.0, 1.0), (0.9, 0.5), (0.5, 1.0), (1.0, 0.1)]
    assert summary.auc_pooled == pytest.approx(area_under_frontier(pooled))
    assert summary.on_frontier == (False, True, True)  # (0, 1) loses to the other seed's (.5, 1).


def test_paper_axis_is_pooled_linear_on_own_naturalness_without_anchor():
    summary = summarize_seeds([*SEED_0, *SEED_1], ANCHORS, rng=generator())
    own = [(0.2, 1.0), (0.4, 0.5), (0.6, 1.0)]
    assert summary.auc_paper_axis == pytest.approx(area_under_frontier(own, kind="linear"))
    assert summary.auc_paper_axis == pytest.approx(0.6)
    falling = [
        point(0, 0.1, 0.9, own=0.2),
        point(1, 0.1, 0.4, own=0.5),
        point(1, 0.1, 0.3, own=0.9),
    ]
    summary = summarize_seeds(falling, ANCHORS, rng=generator())
    assert summary.auc_paper_axis == pytest.approx(0.515)


def test_paper_axis_is_undefined_where_an_own_discriminator_is_missing():
    points = [*SEED_0, point(1, 0.5, 1.0, own=None)]
    assert summarize_seeds(points, ANCHORS, rng=generator()).auc_paper_axis is None
    assert summarize_seeds([], ANCHORS, rng=generator()).auc_paper_axis is None


def test_a_point_with_more_than_one_percent_faults_counts_nowhere():
    faulted = [point(0, 1.0, 1.0, own=1.0, faulted=0.0101), point(1, 1.0, 1.0, faulted=math.nan)]
    clean = summarize_seeds([*SEED_0, *SEED_1], ANCHORS, rng=generator())
    summary = summarize_seeds([faulted[0], *SEED_0, faulted[1], *SEED_1], ANCHORS, rng=generator())
    assert summary.headline() == clean.headline()
    assert summary.on_frontier == (False, False, True, False, True)


def test_a_point_with_one_percent_faults_still_counts():
    summary = summarize_seeds([point(0, 0.9, 0.5, faulted=0.01)], {0: 0.0}, rng=generator())
    assert summary.worst_at["0.9"] == 0.5
    assert summary.on_frontier == (True,)


def test_a_seed_whose_points_all_faulted_shows_canonical_play():
    summary = summarize_seeds([*SEED_0, point(1, 1.0, 1.0, faulted=1.0)], ANCHORS, rng=generator())
    assert summary.auc_by_seed["1"] == pytest.approx(0.2)
    assert summary.worst_at_by_seed["0.8"]["1"] == 0.2


def test_a_point_milder_than_canonical_play_is_not_on_the_frontier():
    summary = summarize_seeds([point(0, 0.9, 0.1)], {0: 0.2}, rng=generator())
    assert summary.on_frontier == (False,)


def test_one_seed_has_no_intervals():
    summary = summarize_seeds(SEED_0, {0: 0.0}, rng=generator())
    assert summary.auc_interval is None
    assert summary.auc_natural_interval is None
    assert summary.worst_at_interval == {"0.8": None, "0.9": None, "0.95": None}
    assert summary.auc == summary.auc_pooled == summary.auc_by_seed["0"]


def test_thirty_seeds_have_bca_intervals_beside_the_others():
    rng = np.random.default_rng(3)
    points = [point(seed, 0.9, float(rng.beta(2, 5))) for seed in range(30)]
    summary = summarize_seeds(points, dict.fromkeys(range(30), 0.0), rng=generator())
    for t_ends, bca in [
        (summary.auc_interval, summary.auc_interval_bca),
        (summary.auc_natural_interval, summary.auc_natural_interval_bca),
        (summary.worst_at_interval["0.9"], summary.worst_at_interval_bca["0.9"]),
    ]:
        assert bca != t_ends
        assert bca == pytest.approx(t_ends, abs=0.02)


def test_headline_is_json_under_the_names_of_the_contract():
    summary = summarize_seeds([*SEED_0, *SEED_1], ANCHORS, rng=generator())
    block = json.loads(json.dumps(summary.headline(), allow_nan=False))
    contract = {
        "worst_at", "worst_at_interval", "auc_natural", "auc", "auc_interval", "auc_by_seed",
        "auc_pooled", "auc_staircase", "auc_linear", "auc_excess", "auc_paper_axis",
    }  # fmt: skip
    assert contract <= set(block)
    assert "on_frontier" not in block
    assert block["worst_at_interval"]["0.9"] == list(summary.worst_at_interval["0.9"])


@settings(max_examples=25)  # Each example is dozens of checked calls.
@given(
    rows=st.lists(st.tuples(st.integers(0, 3), shares, shares), max_size=10),
    anchor=shares,
    data=st.data(),
)
def test_order_of_points_and_seeds_does_not_change_the_headline(rows, anchor, data):
    points = [point(seed, x, y, own=x) for seed, x, y in rows]
    shuffled = data.draw(st.permutations(points))
    forwards = summarize_seeds(points, dict.fromkeys([0, 1, 2, 3], anchor), rng=generator())
    backwards = summarize_seeds(shuffled, dict.fromkeys([3, 2, 1, 0], anchor), rng=generator())
    assert backwards.headline() == forwards.headline()
    assert list(backwards.auc_by_seed) == ["0", "1", "2", "3"]


@settings(max_examples=25)
@given(rows=st.lists(st.tuples(st.integers(0, 2), shares, shares), max_size=10), anchor=shares)
def test_pooling_seeds_never_lowers_the_hull(rows, anchor):
    points = [point(seed, x, y) for seed, x, y in rows]
    summary = summarize_seeds(points, dict.fromkeys(range(3), anchor), rng=generator())
    assert summary.auc_pooled >= max(summary.auc_by_seed.values()) - 1e-12


def test_a_search_without_seeds_is_refused():
    with pytest.raises(ValueError, match="anchors must name at least one seed, got none"):
        summarize_seeds([], {}, rng=generator())


def test_a_point_of_an_unknown_seed_is_refused():
    with pytest.raises(ValueError, match=r"point s4-0\.5 has seed 4, which is not in \[0, 1\]"):
        summarize_seeds([point(4, 0.5, 0.5)], ANCHORS, rng=generator())


def test_points_are_grouped_by_seed_without_the_faulted_ones():
    points = [*SEED_0, point(0, 0.3, 0.3, faulted=0.5), *SEED_1]
    grouped = sound_points_by_seed(points, [0, 1, 2])
    assert {seed: array.tolist() for seed, array in grouped.items()} == {
        0: [[0.0, 1.0], [0.9, 0.5]],
        1: [[0.5, 1.0]],
        2: [],
    }
    assert grouped[2].shape == (0, 2)


def test_band_is_the_mean_and_t_interval_of_the_hulls_at_each_naturalness():
    grid = [0.0, 0.25, 0.9, 1.0]
    by_seed = sound_points_by_seed([*SEED_0, *SEED_1], [0, 1])
    band = interval_band(by_seed, ANCHORS, grid)
    hulls = np.array([hull_at(by_seed[seed], grid, ANCHORS[seed]) for seed in (0, 1)])
    assert band.mean == pytest.approx(hulls.mean(axis=0))
    ends = [t_interval(column) for column in hulls.T]
    assert band.low == pytest.approx([end.low for end in ends])
    assert band.high == pytest.approx([end.high for end in ends])


def test_band_narrows_with_its_confidence():
    by_seed = {0: [(0.5, 0.50)], 1: [(0.5, 0.51)]}
    anchors = {0: 0.1, 1: 0.1}
    narrow = interval_band(by_seed, anchors, [0.2], confidence=0.5)
    wide = interval_band(by_seed, anchors, [0.2])
    assert wide.low < narrow.low < narrow.high < wide.high


def test_band_of_one_seed_is_its_hull_alone():
    band = interval_band({0: [(0.5, 0.8)]}, {0: 0.4}, [0.0, 0.75])
    assert band.mean == pytest.approx([0.8, 0.6])
    assert band.low is None
    assert band.high is None


@pytest.mark.parametrize(
    ("points_by_seed", "anchors", "message"),
    [
        ({}, {}, r"same seeds, at least one: \[\] and \[\]"),
        ({0: [(0.5, 0.5)]}, {1: 0.1}, r"same seeds, at least one: \[0\] and \[1\]"),
    ],
)
def test_band_needs_an_anchor_for_each_seed(points_by_seed, anchors, message):
    with pytest.raises(ValueError, match=message):
        interval_band(points_by_seed, anchors, [0.5])


def test_band_needs_a_confidence_between_zero_and_one():
    with pytest.raises(ValueError, match=r"confidence must lie in \(0, 1\), got 95\.0"):
        interval_band({0: [(0.5, 0.5)]}, {0: 0.1}, [0.5], confidence=95.0)

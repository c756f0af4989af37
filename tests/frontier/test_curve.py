"""The frontier's shape: golden areas, two independent oracles, and what adding a point may do."""

from __future__ import annotations

import inspect
import math

import moocore
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull
from scipy.stats import norm

from rigid.frontier.curve import (
    anchor_height,
    area_under_frontier,
    auc_excess,
    auc_natural,
    hull_at,
    non_dominated,
    worst_at,
)

TWO = [(0.2, 0.9), (0.9, 0.3)]
KINDS = ("hull", "staircase", "linear")
SABOTAGE_ONLY = [(0.0, 1.0)]  # With canonical play at .04: the two robots of equal area.
FAILS_NATURALLY = [(0.0, 0.6), (0.9, 0.5)]

shares = st.one_of(st.integers(0, 10).map(lambda tenths: tenths / 10), st.floats(0.0, 1.0))
pairs = st.tuples(shares, shares)


def chain(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The same coordinates as one falling chain: random points are mostly dominated ones."""
    naturalness, adversarialness = zip(*points, strict=True)
    return list(zip(sorted(naturalness), sorted(adversarialness, reverse=True), strict=True))


scattered = st.lists(pairs, min_size=1, max_size=12)
point_lists = scattered | scattered.map(chain)
kinds = st.sampled_from(KINDS)


@pytest.mark.parametrize(
    ("points", "staircase", "linear", "hull"),
    [
        pytest.param(TWO, 0.390, 0.600, 0.600, id="two-points"),
        pytest.param([*TWO, (0.5, 0.4)], 0.420, 0.515, 0.600, id="one-below-the-line"),
        pytest.param([*TWO, (0.5, 0.8)], 0.540, 0.655, 0.655, id="one-above-the-line"),
        pytest.param([*TWO, (0.5, 0.2)], 0.390, 0.600, 0.600, id="one-dominated"),
        pytest.param(
            [(0.0, 1.0), (0.1, 0.9), (0.2, 0.6), (0.25, 0.3), (1.0, 0.2)],
            *(0.09 + 0.06 + 0.015 + 0.15, 0.095 + 0.075 + 0.0225 + 0.1875, 0.6),
            id="one-point-outshines-three",
        ),
        pytest.param([(1.0, 0.25)], 0.25, 0.25, 0.25, id="canonical-only"),
        pytest.param([(0.0, 1.0), (1.0, 0.1)], 0.10, 0.55, 0.55, id="sabotage-and-canonical"),
        pytest.param([(0.0, 1.0)], 0.0, 0.0, 0.0, id="sabotage-alone-has-no-width"),
    ],
)
def test_golden_areas(points, staircase, linear, hull):
    assert area_under_frontier(points) == pytest.approx(hull)
    assert area_under_frontier(points, kind="hull") == pytest.approx(hull)
    assert area_under_frontier(points, kind="linear") == pytest.approx(linear)
    assert area_under_frontier(np.array(points), kind="staircase") == pytest.approx(staircase)


def test_the_area_hides_what_the_natural_end_shows():
    sabotage = area_under_frontier(SABOTAGE_ONLY, anchor=0.04)
    natural = area_under_frontier(FAILS_NATURALLY, anchor=0.04)
    assert (sabotage, natural) == pytest.approx((0.520, 0.522))
    assert auc_natural(SABOTAGE_ONLY, anchor=0.04) == pytest.approx(0.136)
    assert auc_natural(FAILS_NATURALLY, anchor=0.04) == pytest.approx(0.349 / 0.9)
    assert worst_at(SABOTAGE_ONLY, 0.9, anchor=0.04) == 0.04
    assert worst_at(FAILS_NATURALLY, 0.9, anchor=0.04) == 0.5


@pytest.mark.parametrize("kind", KINDS)
def test_an_anchor_is_the_canonical_point_at_naturalness_one(kind):
    expected = area_under_frontier([*TWO, (1.0, 0.1)], kind=kind)
    assert area_under_frontier(TWO, anchor=0.1, kind=kind) == pytest.approx(expected)
    assert area_under_frontier(TWO, anchor=(1.0, 0.1), kind=kind) == pytest.approx(expected)
    assert area_under_frontier(TWO, np.array([1.0, 0.1]), kind=kind) == pytest.approx(expected)
    assert area_under_frontier(TWO, kind=kind) < expected


@pytest.mark.parametrize("kind", KINDS)
def test_without_any_attack_the_frontier_is_canonical_play(kind):
    assert area_under_frontier([], anchor=0.3, kind=kind) == pytest.approx(0.3)
    assert area_under_frontier(np.empty((0, 2)), anchor=0.3, kind=kind) == pytest.approx(0.3)


@pytest.mark.parametrize("kind", KINDS)
def test_attacks_milder_than_canonical_play_change_nothing(kind):
    assert area_under_frontier([(0.4, 0.1)], anchor=0.3, kind=kind) == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("kind", "domain", "expected"),
    [
        ("hull", (0.1, 0.55), 0.1 * 0.9 + 0.35 * (0.9 + 0.6) / 2),
        ("linear", (0.1, 0.55), 0.1 * 0.9 + 0.35 * (0.9 + 0.6) / 2),
        ("staircase", (0.1, 0.55), 0.1 * 0.9 + 0.35 * 0.3),
        ("hull", (0.8, 1.0), 0.1 * (0.3 + 0.06 / 0.7 + 0.3) / 2),
        ("staircase", (0.8, 1.0), 0.1 * 0.3),
        ("hull", (0.95, 1.0), 0.0),
        ("staircase", (0.95, 1.0), 0.0),
    ],
)
def test_a_domain_cuts_the_window_and_leaves_the_curve(kind, domain, expected):
    assert area_under_frontier(TWO, kind=kind, domain=domain) == pytest.approx(expected)


@given(points=point_lists, kind=kinds, cut=st.floats(0.01, 0.99))
def test_areas_of_adjoining_domains_add_up(points, kind, cut):
    left = area_under_frontier(points, kind=kind, domain=(0.0, cut))
    right = area_under_frontier(points, kind=kind, domain=(cut, 1.0))
    assert left + right == pytest.approx(area_under_frontier(points, kind=kind), abs=1e-12)


def test_non_dominated_keeps_the_outermost_points():
    points = [(0.2, 0.9), (0.5, 0.2), (0.9, 0.3), (0.2, 0.8), (0.1, 0.9)]
    assert non_dominated(points).tolist() == [True, False, True, False, False]


def test_equal_points_do_not_dominate_each_other():
    assert non_dominated([(0.5, 0.5), (0.5, 0.5), (0.5, 0.4)]).tolist() == [True, True, False]


def test_of_no_points_none_is_dominated():
    assert non_dominated([]).tolist() == []


@given(points=point_lists)
def test_non_dominated_agrees_with_moocore(points):
    oracle = moocore.is_nondominated(-np.array(points), keep_weakly=True)
    assert non_dominated(points).tolist() == oracle.tolist()


@given(points=point_lists)
def test_staircase_is_the_hypervolume(points):
    oracle = moocore.hypervolume(-np.array(points), ref=(0.0, 0.0))
    assert area_under_frontier(points, kind="staircase") == pytest.approx(oracle, abs=1e-12)


@given(points=point_lists)
def test_hull_is_the_convex_hull_of_all_that_is_no_worse(points):
    """Whoever attains (x, y) attains the box below it, and mixing attains the hull of all boxes."""
    corners = [(0.0, 0.0), (1e-9, 0.0), (0.0, 1e-9)]  # Never flat, which Qhull refuses.
    for x, y in points:
        corners += [(x, y), (x, 0.0), (0.0, y)]
    oracle = ConvexHull(corners).volume  # In two dimensions the "volume" is the area.
    assert area_under_frontier(points) == pytest.approx(oracle, abs=1e-9)


@given(points=point_lists)
def test_hull_is_above_linear_is_above_staircase(points):
    hull, linear, staircase = (
        area_under_frontier(points, kind=kind) for kind in ("hull", "linear", "staircase")
    )
    assert 0.0 <= staircase <= linear + 1e-12
    assert linear <= hull + 1e-12
    assert hull <= 1.0 + 1e-12


@given(points=point_lists, extra=pairs, anchor=st.none() | shares)
def test_another_point_never_lowers_hull_and_staircase(points, extra, anchor):
    for kind in ("hull", "staircase"):
        before = area_under_frontier(points, anchor, kind)
        assert area_under_frontier([*points, extra], anchor, kind) >= before - 1e-12


def test_another_attack_can_lower_the_linear_area():
    more = [*TWO, (0.5, 0.4)]
    assert area_under_frontier(more, kind="linear") < area_under_frontier(TWO, kind="linear")


@given(points=point_lists, kind=kinds, data=st.data())
def test_order_of_the_points_does_not_change_the_area(points, kind, data):
    shuffled = data.draw(st.permutations(points))
    assert area_under_frontier(shuffled, kind=kind) == area_under_frontier(points, kind=kind)


@given(points=point_lists, kind=kinds, scale=st.tuples(shares, shares))
def test_a_dominated_point_does_not_change_the_area(points, kind, scale):
    dominated = (points[0][0] * scale[0], points[0][1] * scale[1])
    expected = area_under_frontier(points, kind=kind)
    assert area_under_frontier([*points, dominated], kind=kind) == expected


@given(points=point_lists, anchor=shares)
def test_natural_area_is_the_mean_height_of_the_hull_there(points, anchor):
    grid = np.linspace(0.8, 1.0, 2001)
    mean_height = np.trapezoid(hull_at(points, grid, anchor), grid) / 0.2
    assert auc_natural(points, anchor) == pytest.approx(mean_height, abs=1e-3)


def test_natural_area_ends_where_points_end_without_an_anchor():
    assert auc_natural([(0.9, 0.5)]) == pytest.approx(0.25)


@given(points=point_lists, anchor=shares)
def test_hull_height_is_concave_falling_and_over_every_point(points, anchor):
    heights = hull_at(points, np.linspace(0.0, 1.0, 21), anchor)
    assert (np.diff(heights) <= 1e-12).all()
    assert (np.diff(heights, n=2) <= 1e-12).all()
    naturalness, adversarialness = np.array([*points, (1.0, anchor)]).T
    assert (hull_at(points, naturalness, anchor) >= adversarialness - 1e-12).all()


def test_hull_height_holds_left_of_the_points_and_is_zero_right_of_them():
    assert hull_at(TWO, [0.0, 0.2, 0.55, 0.9, 0.91, 1.0]).tolist() == pytest.approx(
        [0.9, 0.9, 0.6, 0.3, 0.0, 0.0]
    )
    assert hull_at(TWO, [1.0], anchor=0.1).tolist() == [0.1]


def test_worst_at_takes_points_and_counts_the_threshold_itself():
    points = [(0.5, 1.0), (0.9, 0.3), (0.92, 0.4)]
    assert worst_at(points, 0.9, anchor=0.05) == 0.4  # The hull is at .5 there.
    assert worst_at(points, 0.92, anchor=0.05) == 0.4
    assert worst_at(points, 0.8, anchor=0.05) == 0.4


def test_worst_at_falls_back_on_canonical_play_only_where_no_point_is():
    assert worst_at([(0.5, 1.0)], 0.8, anchor=0.05) == 0.05
    assert worst_at([], 0.8, anchor=(1.0, 0.05)) == 0.05
    assert worst_at([(0.85, 0.02)], 0.8, anchor=0.05) == 0.02


@given(points=point_lists, anchor=shares, threshold=shares)
def test_worst_at_is_never_above_the_hull(points, anchor, threshold):
    height = hull_at(points, [threshold], anchor)[0]
    assert worst_at(points, threshold, anchor) <= height + 1e-12


def test_excess_of_sabotage_and_canonical_play_alone_is_zero():
    assert auc_excess(SABOTAGE_ONLY, anchor=0.04) == pytest.approx(0.0)
    assert auc_excess([], anchor=0.3) == pytest.approx(0.0)
    assert auc_excess([(0.2, 0.1)], anchor=0.3) == pytest.approx(0.0)


def test_excess_is_the_area_over_the_chord():
    assert auc_excess(FAILS_NATURALLY, anchor=0.04) == pytest.approx(0.522 - (0.6 + 0.04) / 2)


@given(points=point_lists, anchor=shares)
def test_excess_is_never_negative(points, anchor):
    assert auc_excess(points, anchor) >= -1e-12


@pytest.mark.parametrize(("tolerance", "expected"), [(1, 0.933249), (2, 0.586860), (3, 0.505385)])
def test_hull_of_the_best_adversary_in_the_offset_catch(tolerance, expected):
    """One step, c = 1[x > t], κ = 4: y = min(1, 1 - x + a) with a = min(1, 4 Φ(-t))."""
    canonical = norm.cdf(-tolerance)
    a = min(1.0, 4 * canonical)
    best = [(x, min(1.0, 1.0 - x + a)) for x in np.linspace(0.0, 1.0, 11)]
    assert area_under_frontier(best) == pytest.approx(a + (1 - a**2) / 2, abs=3e-3)
    assert area_under_frontier([(a, 1.0), (1.0, a)]) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(("tolerance", "expected"), [(1, 0.72784), (2, 0.44523), (3, 0.21235)])
def test_linear_area_of_mean_shifts_in_the_offset_catch(tolerance, expected):
    """x = Φ(ln 4 / m - m / 2), y = Φ(m - t) for a canonical human shifted by m."""
    shift = np.linspace(0.01, 12.0, 1500)
    points = np.column_stack([norm.cdf(np.log(4) / shift - shift / 2), norm.cdf(shift - tolerance)])
    assert area_under_frontier(points, kind="linear") == pytest.approx(expected, abs=2e-4)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([0.1, 0.2, 0.3], r"points must have shape \(n, 2\), got \(3,\)"),
        ([(0.1, 0.2, 0.3)], r"points must have shape \(n, 2\), got \(1, 3\)"),
        ([(0.1, 0.2), (0.1, 1.2)], r"points must lie in \[0, 1\].*got \[0\.1, 1\.2\]"),
        ([(-0.1, 0.2)], r"points must lie in \[0, 1\].*got \[-0\.1, 0\.2\]"),
        ([(math.nan, 0.2)], r"points must lie in \[0, 1\].*got \[nan, 0\.2\]"),
        ([], "points are empty and there is no anchor"),
    ],
)
def test_malformed_points_are_refused(points, message):
    as_users_call_it = inspect.unwrap(area_under_frontier)  # The suite checks shapes before we can.
    with pytest.raises(ValueError, match=message):
        as_users_call_it(np.array(points))


@pytest.mark.parametrize(
    ("anchor", "message"),
    [
        ((0.04, 1.0), r"anchor must stand at naturalness 1, got \(0\.04, 1\.0\)"),
        (1.5, r"anchor must have an adversarialness in \[0, 1\], got 1\.5"),
        (-0.1, r"anchor must have an adversarialness in \[0, 1\], got -0\.1"),
        (math.nan, r"anchor must have an adversarialness in \[0, 1\], got nan"),
        (
            (1.0, 0.1, 0.2),
            r"anchor must be one number or a pair \(1, y\), got \(1\.0, 0\.1, 0\.2\)",
        ),
    ],
)
def test_malformed_anchors_are_refused(anchor, message):
    with pytest.raises(ValueError, match=message):
        anchor_height(anchor)
    with pytest.raises(ValueError, match=message):
        area_under_frontier(TWO, anchor)


@pytest.mark.parametrize("domain", [(0.5, 0.5), (0.9, 0.1), (-0.1, 1.0), (0.0, 1.1)])
def test_malformed_domains_are_refused(domain):
    with pytest.raises(ValueError, match=r"domain must satisfy 0 <= low < high <= 1, got \("):
        area_under_frontier(TWO, domain=domain)


def test_unknown_kinds_are_refused():
    with pytest.raises(ValueError, match="kind must be hull, staircase or linear, got 'convex'"):
        inspect.unwrap(area_under_frontier)(TWO, kind="convex")


@pytest.mark.parametrize("threshold", [-0.1, 1.1, math.nan])
def test_malformed_thresholds_are_refused(threshold):
    with pytest.raises(ValueError, match=r"threshold must lie in \[0, 1\], got"):
        worst_at(TWO, threshold, anchor=0.1)


@pytest.mark.parametrize("grid", [[1.1], [-0.1], [math.nan], [[0.1, 0.2]]])
def test_malformed_grids_are_refused(grid):
    with pytest.raises(ValueError, match=r"grid must be one row of values in \[0, 1\], got"):
        inspect.unwrap(hull_at)(TWO, np.array(grid))

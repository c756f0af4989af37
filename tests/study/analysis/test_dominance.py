"""Who lies above the frontier."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.study.analysis.dominance import (
    Frontage,
    clearly_above,
    dominated,
    episodes_above,
    height_at,
    hull_height,
    share,
)

FRONT = Frontage(
    naturalness=np.array([0.1, 0.6, 1.0]),
    adversarialness=np.array([0.9, 0.5, 0.1]),
    of_episodes=np.array([1.0, 0.7, 0.2]),
)


@pytest.mark.parametrize(
    ("x", "y", "expected"),
    [
        pytest.param(0.6, 0.5, True, id="equal-on-both-axes"),
        pytest.param(0.61, 0.5, False, id="more-natural-than-any-as-harmful"),
        pytest.param(0.6, 0.51, False, id="more-harmful-than-any-as-natural"),
        pytest.param(0.0, 0.9, True, id="less-natural-than-all"),
        pytest.param(1.0, 0.1, True, id="canonical-play-counts"),
        pytest.param(0.3, 0.6, False, id="under-the-hull-but-above-the-points"),
    ],
)
def test_a_point_dominates_who_is_at_most_as_natural_and_as_adversarial(x, y, expected):
    assert dominated(FRONT, x, y) is expected


def test_the_hull_lies_between_points_where_humans_mix():
    assert hull_height(FRONT, 0.35) == pytest.approx(0.7)
    assert height_at(FRONT.naturalness, FRONT.adversarialness, 0.35) == 0.5


def test_episodes_are_held_against_quantiles_of_episodes_and_not_against_means():
    harm = np.array([0.55, 0.65, 0.75])
    assert episodes_above(FRONT, 0.6, harm) == 1
    assert episodes_above(FRONT, 0.05, harm) == 0


def test_scatter_alone_is_not_clearly_above():
    assert not clearly_above(0.5, np.array([0.2, 0.9, 0.6]))
    assert clearly_above(0.5, np.array([0.58, 0.6, 0.61]))
    assert not clearly_above(0.5, np.array([0.9]))


def test_none_of_eight_leaves_almost_a_third_possible():
    """Clopper and Pearson: 1 - 0.05^(1/8)."""
    found = share([False] * 8)
    assert (found.above, found.of) == (0, 8)
    assert found.at_most == pytest.approx(1 - 0.05 ** (1 / 8))


def test_all_of_n_leave_everything_possible():
    assert share([True] * 3).at_most == 1.0


def test_nobody_leaves_nothing_to_say():
    assert share([]).at_most is None

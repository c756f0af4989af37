"""Success over robots: means by hand, and an interval that is never narrower than either cause."""

from __future__ import annotations

import pytest

from rigid.frontier.intervals import t_interval
from rigid.frontier.successes import Played, success_of


def test_the_mean_is_over_robots_of_their_means_over_humans():
    """A robot that met more humans counts once."""
    played = [Played(0, 1.0, 10), Played(0, 0.8, 10), Played(0, 0.6, 10), Played(1, 0.0, 10)]
    assert success_of(played).mean == pytest.approx(0.4)


def test_one_robot_has_wilsons_interval_over_its_episodes():
    low, high = success_of([Played(0, 1.0, 100)]).interval
    assert (low, high) == (pytest.approx(0.963, abs=1e-3), 1.0)


def test_robots_that_differ_widen_it():
    shares = [0.7, 0.8, 0.9]
    found = success_of([Played(number, share, 10_000) for number, share in enumerate(shares)])
    assert found.interval == pytest.approx(t_interval(shares))


def test_robots_that_agree_leave_the_episodes():
    found = success_of([Played(number, 0.5, 50) for number in range(3)])
    assert found.interval.low == pytest.approx(0.421, abs=1e-3)  # Wilson, 75 of 150.


def test_nothing_played_is_unknown():
    assert success_of([]) is None


@pytest.mark.parametrize("played", [Played(0, 1.2, 10), Played(0, 0.5, 0)])
def test_what_is_no_share_is_refused(played):
    with pytest.raises(ValueError, match="success must be a share of at least one episode, got P"):
        success_of([played])

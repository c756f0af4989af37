"""Time that is left: an expectation that what is seen replaces."""

from __future__ import annotations

import pytest

from rigid.commands.terminal.pace import Pace


class Watch:
    """A time that tests set."""

    def __init__(self):
        self.seconds = 50.0

    def __call__(self):
        return self.seconds


@pytest.fixture
def watch():
    return Watch()


@pytest.fixture
def pace(watch):
    return Pace(watch)


def test_nothing_is_known_before_the_first_step(pace):
    assert pace.left(10) is None


def test_before_the_first_step_what_is_expected_counts_down(pace, watch):
    pace.expect(2.0, starting=30.0)
    assert pace.left(100) == 30.0 + 50.0
    watch.seconds += 20.0
    assert pace.left(100) == 10.0 + 50.0


def test_a_late_beginning_leaves_the_time_of_the_steps(pace, watch):
    pace.expect(2.0, starting=30.0)
    watch.seconds += 300.0
    assert pace.left(100) == 50.0


@pytest.mark.parametrize("share", [1, 10, 50])
def test_what_passes_before_the_first_steps_says_nothing_of_the_speed(pace, watch, share):
    pace.expect(2.0, starting=30.0)
    watch.seconds += 600.0
    pace.advance(share)
    assert pace.left(100 - share) == pytest.approx((100 - share) / 2.0)


def test_a_speed_that_is_seen_for_long_replaces_the_expected_one(pace, watch):
    pace.expect(2.0)
    pace.advance(1)
    for _ in range(1000):
        watch.seconds += 1.0
        pace.advance(8)
    assert pace.left(800) == pytest.approx(100.0, rel=0.02)


def test_a_first_slow_step_does_not_make_hours_of_minutes(pace, watch):
    pace.expect(1000.0)
    pace.advance(10)
    watch.seconds += 5.0
    pace.advance(10)
    assert pace.left(60_000) < 60.0 * 1.3


def test_between_two_steps_the_time_left_does_not_grow(pace, watch):
    pace.expect(2.0)
    pace.advance(1)
    watch.seconds += 10.0
    pace.advance(20)
    before = pace.left(100)
    watch.seconds += 30.0
    assert pace.left(100) == before


def test_without_an_expectation_the_speed_is_that_of_steps_after_the_first(pace, watch):
    pace.advance(5)
    assert pace.left(10) is None
    watch.seconds += 4.0
    pace.advance(2)
    assert pace.left(10) == 20.0

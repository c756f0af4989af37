"""The clock of an episode neither drifts nor bunches."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from rigid.study.service.pacing import CATCH_UP, Schedule

PERIOD = 0.1


def begun(delays) -> np.ndarray:
    """When steps begin that are each late by so much."""
    schedule, times = Schedule(PERIOD, 0.0), []
    for delay in delays:
        now = schedule.due + delay
        schedule.began(now)
        times.append(now)
    return np.array(times)


def test_steps_that_are_in_time_do_not_drift():
    assert np.allclose(begun(np.zeros(1000)), PERIOD * np.arange(1000))


def test_small_delays_do_not_add_up():
    assert begun(np.full(1000, 0.004))[-1] - PERIOD * 999 < 0.05


@settings(max_examples=30)
@given(st.lists(st.floats(0, 1), min_size=2, max_size=50))
def test_steps_never_bunch(delays):
    assert np.diff(begun(delays)).min() >= (1 - CATCH_UP) * PERIOD - 1e-9


def test_a_short_delay_is_worked_off_a_little_at_a_time():
    times = begun([0, 0.03, 0, 0, 0, 0])
    assert np.allclose(np.diff(times), [0.13, 0.09, 0.09, 0.09, 0.1])


def test_a_delay_of_more_than_a_step_is_given_up():
    times = begun([0, 0.5, 0, 0, 0])
    assert np.allclose(np.diff(times), [0.6, 0.1, 0.1, 0.1])

"""Examples of motion, and the predictor to beat."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.learning.motion import (
    Motion,
    constant_velocity,
    motion_of,
    root_mean_square,
    shown_columns,
)
from tests.learning.reach import ShownReach
from tests.toys import ToyReach

# Two numbers, of which the second shows the human; it moves as the squares.
SEEN = np.stack([np.zeros(5), np.arange(5.0) ** 2], axis=1)[:, None].astype(np.float32)
SOUND = np.ones((5, 1), np.float32)


def test_the_task_says_what_shows_the_human():
    assert shown_columns(ShownReach()) == (1,)


def test_a_task_that_does_not_is_told_what_is_missing():
    with pytest.raises(UserError, match=r"'toy-reach' does not say which .*: give it `shown_hum"):
        shown_columns(ToyReach())


def test_a_displacement_belongs_to_the_window_that_ends_before_it():
    motion = motion_of(SEEN, SOUND, [1], memory=2, ahead=2)
    np.testing.assert_array_equal(motion.windows[:, 0, 1], [0, 1, 4])  # The newest.
    np.testing.assert_array_equal(motion.windows[:, 0, 3], [0, 0, 1])  # The one before it.
    np.testing.assert_array_equal(motion.displacement[:, 0, 0], [4, 8, 12])


def test_constant_velocity_goes_on_as_in_the_last_step():
    motion = motion_of(SEEN, SOUND, [1], memory=2, ahead=2)
    steady = constant_velocity(motion.windows, [1], memory=2, ahead=2)
    np.testing.assert_array_equal(steady[:, 0, 0], [0, 2, 6])


def test_what_physics_spoilt_neither_teaches_nor_counts():
    seen, sound = SEEN.copy(), SOUND.copy()
    seen[3:], sound[3:] = 1e6, 0
    motion = motion_of(seen, sound, [1], memory=2, ahead=1)
    np.testing.assert_array_equal(motion.weight[:, 0], [1, 1, 0, 0])
    np.testing.assert_array_equal(motion.displacement[:, 0, 0], [1, 3, 0, 0])
    assert root_mean_square(np.zeros((4, 1, 1)), motion) == pytest.approx(5**0.5)


def test_the_error_is_that_of_a_coordinate():
    nothing = np.zeros((2, 3, 4))
    motion = Motion(nothing, nothing, np.ones((2, 3)))
    assert root_mean_square(np.full((2, 3, 4), 0.5), motion) == pytest.approx(0.5)

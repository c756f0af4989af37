"""Food lies on a level spoon, falls off a tilted or jerked one, and is eaten near the mouth."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rigid.tasks.feeding import food
from rigid.tasks.feeding.food import GRAVITY, PIECES, SPILL_TILT, Piece

LEVEL = Rotation.from_euler("x", 90, degrees=True)  # The bowl's y axis up.
AXES = ((1, 0, 0), (0, 1, 0), (0.6, -0.8, 0))


def quaternion(rotation):
    return rotation.as_quat(scalar_first=True)[None]


def tilted(degrees, axis=(1, 0, 0)):
    return quaternion(Rotation.from_rotvec(np.deg2rad(degrees) * np.array(axis)) * LEVEL)


def held():
    return np.full((1, 8), Piece.HELD)


def spills(turned, acceleration=(0.0, 0.0, 0.0)):
    angle = food.tilt(turned, np.array([acceleration], dtype=float))
    return int(food.spilled_now(held(), angle).sum())


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize(("degrees", "count"), [(0, 0), (26, 0), (28, 1), (36, 4), (47, 8)])
def test_the_more_the_spoon_tilts_the_more_falls_whichever_way(axis, degrees, count):
    assert spills(tilted(degrees, axis)) == count


def test_all_falls_off_a_spoon_that_is_upside_down():
    assert spills(tilted(180)) == 8


@pytest.mark.parametrize(("degrees", "count"), [(26, 0), (28, 1), (60, 8)])
def test_a_sideways_acceleration_is_felt_as_a_tilt(degrees, count):
    sideways = GRAVITY * np.tan(np.deg2rad(degrees))
    assert spills(tilted(0), (sideways, 0, 0)) == count


def test_a_push_upwards_holds_the_food_in_a_tilted_spoon():
    assert spills(tilted(30)) == 1
    gentle = food.tilt(tilted(30), np.array([[0.0, 0.0, 20.0]]))
    assert gentle == pytest.approx(np.deg2rad(30))


def test_a_falling_spoon_has_a_tilt_that_is_a_number():
    assert np.isfinite(food.tilt(tilted(0), np.array([[0.0, 0.0, -GRAVITY]]))).all()


def test_what_has_left_the_spoon_does_not_fall_again():
    state = np.array([[Piece.SPILLED, Piece.EATEN] + [Piece.HELD] * 6])
    falling = food.spilled_now(state, np.array([np.pi]))
    np.testing.assert_array_equal(falling, [[False, False] + [True] * 6])


@pytest.mark.parametrize(("gap", "eaten"), [(0.029, True), (0.031, False)])
def test_a_piece_is_eaten_within_three_centimetres_of_the_mouth(gap, eaten):
    where, mouth = np.full((1, 5, 8, 3), 9.0), np.zeros((1, 5, 3))
    where[0, 2, 4] = gap, 0, 0  # At one physics step of five.
    expected = np.zeros((1, 8), dtype=bool)
    expected[0, 4] = eaten
    np.testing.assert_array_equal(food.eaten_now(held(), where, mouth), expected)


def test_spilled_food_is_not_eaten():
    state = np.full((1, 8), Piece.SPILLED)
    assert not food.eaten_now(state, np.zeros((1, 5, 8, 3)), np.zeros((1, 5, 3))).any()


def test_pieces_ride_on_the_spoon():
    turned, at = Rotation.from_euler("xyz", (0.3, -1.2, 2.0)), np.array([[0.1, -0.5, 1.1]])
    found = food.places(at, quaternion(turned))
    np.testing.assert_allclose(found[0], at[0] + turned.apply(PIECES), atol=1e-12)


def test_the_highest_pieces_fall_first_and_all_lie_in_the_bowl():
    assert (np.diff(PIECES[:, 1]) <= 0).all()
    assert (np.diff(SPILL_TILT) > 0).all()
    assert (np.abs(PIECES) <= (0.0179, 0.0173, 0.0245)).all()


def test_six_of_eight_pieces_are_enough():
    assert food.ENOUGH == 6

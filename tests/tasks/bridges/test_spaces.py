"""Spaces as rows of numbers in [-1, 1], and those that cannot be."""

import numpy as np
import pytest
from gymnasium import spaces

from rigid.errors import UserError
from rigid.tasks.bridges.spaces import deed_of, sight_of


@pytest.mark.parametrize(
    ("row", "action"),
    [([-1, 1], [0, 30]), ([0, 0], [2, 20]), ([1, -1], [4, 10]), ([9, -9], [4, 10])],
)
def test_a_box_is_stretched_to_minus_one_and_one(row, action):
    deed = deed_of(spaces.Box(np.array([0, 10]), np.array([4, 30]), dtype=np.float32), "x")
    found = deed.action(np.array(row, float))
    np.testing.assert_allclose(found, action)
    assert found.dtype == np.float32


def test_a_box_keeps_its_shape_and_its_whole_numbers():
    deed = deed_of(spaces.Box(0, 255, (2, 2), np.uint8), "x")
    found = deed.action(np.array([-1, 0.01, 0.5, 1]))
    assert deed.size == 4
    np.testing.assert_array_equal(found, [[0, 129], [191, 255]])
    assert deed.space.contains(found)


@pytest.mark.parametrize("bound", [0.1, 1 / 3, 0.7])
def test_the_bounds_themselves_are_in_the_space(bound):
    box = spaces.Box(-bound, bound, (1,), np.float32)
    for row in (-1.0, 1.0):
        assert box.contains(deed_of(box, "x").action(np.array([row])))


@pytest.mark.parametrize(
    ("space", "row", "action", "choices"),
    [
        (spaces.Discrete(3), [0.1, -0.5, 0.3], 2, (3,)),
        (spaces.Discrete(2, start=5), [-0.2, -0.5], 5, (2,)),
        (spaces.MultiDiscrete([2, 3]), [0, 1, 0.1, 0.9, 0.2], [1, 1], (2, 3)),
        (spaces.MultiBinary(2), [0, 1, 1, 0], [1, 0], (2, 2)),
    ],
)
def test_of_a_discrete_action_the_largest_score_is_taken(space, row, action, choices):
    deed = deed_of(space, "x")
    found = deed.action(np.array(row, float))
    assert deed.choices == choices
    assert space.contains(found)
    np.testing.assert_array_equal(found, action)


def test_an_onlooker_sees_choices_and_no_scores():
    deed = deed_of(spaces.MultiDiscrete([2, 3]), "x")
    shown = deed.shown(np.array([0.1, 0.2, -0.5, -0.4, -0.9]))
    np.testing.assert_array_equal(shown, [-1, 1, -1, 1, -1])
    np.testing.assert_array_equal(deed.shown(shown), shown)


def test_an_onlooker_sees_reals_as_the_world_takes_them():
    deed = deed_of(spaces.Box(0, 5, (2,)), "x")
    np.testing.assert_allclose(deed.shown(np.array([0.5, 3.0])), [0.5, 1.0])


def test_dictionaries_and_tuples_are_joined_with_names():
    space = spaces.Dict({
        "hand": spaces.Box(-1, 1, (2,)),
        "itch": spaces.Discrete(2),
        "other": spaces.Tuple([spaces.Box(0, 1, (1,)), spaces.MultiBinary(2)]),
    })  # fmt: skip
    sight = sight_of(space, "x")
    assert sight.names == (
        "hand_0", "hand_1", "itch_0", "itch_1", "other_0", "other_1_0", "other_1_1",
    )  # fmt: skip
    seen = {
        "hand": np.array([0.5, -0.5], np.float32),
        "itch": 1,
        "other": (np.array([0.25], np.float32), np.array([1, 0], np.int8)),
    }
    np.testing.assert_array_equal(sight.row(seen), [0.5, -0.5, 0, 1, 0.25, 1, 0])


def test_a_single_box_is_flattened_as_it_is():
    sight = sight_of(spaces.Box(-np.inf, np.inf, (2, 2)), "x")
    assert sight.names == tuple(f"observation_{number}" for number in range(4))
    np.testing.assert_array_equal(sight.row(np.array([[1e6, 2], [3, 4]])), [1e6, 2, 3, 4])


def test_an_action_without_bounds_is_refused_with_its_space():
    with pytest.raises(UserError, match=r"Box\(-inf, inf, \(3,\), float32\) of agent 'a' has no"):
        deed_of(spaces.Box(-np.inf, np.inf, (3,)), "agent 'a'")


@pytest.mark.parametrize("space", [spaces.Text(5), spaces.Dict(a=spaces.Discrete(2)), 7])
def test_other_actions_are_refused_with_their_space(space):
    with pytest.raises(UserError, match=r"action space .*(Text|Dict|7).* is not supported"):
        deed_of(space, "x")


def test_an_observation_of_unknown_size_is_refused_with_its_space():
    with pytest.raises(UserError, match=r"observation space Text.* of the robot is not"):
        sight_of(spaces.Dict(a=spaces.Discrete(2), b=spaces.Text(5)), "the robot")

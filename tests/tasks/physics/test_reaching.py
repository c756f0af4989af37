"""A hand goes where it is told, as far as joints and servos let it, and never jerks."""

import numpy as np
import pytest

from rigid.tasks.itch_scratching.posture import arm_of
from rigid.tasks.itch_scratching.task import ItchScratching
from rigid.tasks.physics.reaching import DAMPING, bounded_change

WIDE = np.tile([-3.0, 3.0], (4, 1))
NOTHING = np.zeros(4)
JACOBIAN = np.array([[0.6, 0.3, 0.0, 0.0], [0.0, 0.5, 0.2, 0.0], [0.0, 0.0, 0.4, 0.0]])
"""Of a point that the last of four joints does not move [m/rad]."""


@pytest.fixture(scope="module")
def task():
    return ItchScratching()


@pytest.fixture(scope="module")
def arm(task):
    return arm_of(task.model, task.parameters)


def test_the_change_moves_the_point_where_it_should_go():
    away = np.array([0.02, -0.03, 0.01])
    change = bounded_change(JACOBIAN, away, NOTHING, WIDE)
    assert np.linalg.norm(JACOBIAN @ change - away) < 0.15 * np.linalg.norm(away)


def test_no_direction_asks_for_more_than_the_damping_allows():
    """A damped inverse is at most 1 / (2 damping), however little the joints move the point."""
    for size in (1.0, 0.1, 0.01, 1e-6, 0.0):
        change = bounded_change(size * JACOBIAN, np.array([0.0, 0, 1.0]), NOTHING, np.inf * WIDE)
        assert np.linalg.norm(change) <= 1 / (2 * DAMPING) + 1e-12


def test_a_joint_stops_at_its_bound_and_others_go_on_for_it():
    away, bounds = np.array([0.1, 0.0, 0.0]), WIDE.copy()
    bounds[0] = (-0.02, 0.02)
    free, bound = (bounded_change(JACOBIAN, away, NOTHING, b) for b in (WIDE, bounds))
    assert free[0] > 0.02
    assert bound[0] == 0.02
    assert bound[1] > free[1]


def test_all_joints_at_their_bounds_change_no_further():
    bounds = np.tile([0.0, 0.0], (4, 1))
    np.testing.assert_array_equal(bounded_change(JACOBIAN, np.ones(3), NOTHING, bounds), NOTHING)


def test_what_does_not_move_the_point_follows_the_pull_in_full():
    pull = np.array([0.0, 0.0, 0.0, 0.2])
    np.testing.assert_allclose(bounded_change(JACOBIAN, np.zeros(3), pull, WIDE), pull)


def test_the_pull_leaves_the_point_where_it_is():
    change = bounded_change(JACOBIAN, np.zeros(3), np.array([0.3, -0.3, 0.3, 0.0]), WIDE)
    assert np.linalg.norm(JACOBIAN @ change) < 0.002


def test_an_action_stays_within_its_range_and_keeps_its_direction(arm):
    still, start = np.zeros(10), np.deg2rad([0, 10, 0, 40, -20, 0, -60, 0, 0, 0])
    place = arm.place(start)

    def rest(_):
        return start

    near, far = (arm.towards(start, still, place + size * np.array([0, -0.6, 0.8]), rest)
                 for size in (0.01, 5.0))  # fmt: skip
    assert np.abs(far).max() == pytest.approx(1.0)
    assert near @ far / np.linalg.norm(near) / np.linalg.norm(far) > 0.99


def test_a_hand_that_is_where_it_should_be_keeps_still(arm):
    angles = np.deg2rad([0, 0, 0, 30, 0, 0, -90, 0, 0, 0])
    action = arm.towards(angles, np.zeros(10), arm.place(angles), lambda _: angles)
    np.testing.assert_allclose(action, 0, atol=1e-12)


def test_an_outstretched_arm_answers_a_millimetre_with_little(arm):
    """The elbow is straight: the hand cannot go further out, and J has lost a rank."""
    angles, still = np.deg2rad([0, 0, 0, 30, -60, 0, 0, 0, 0, 0.0]), np.zeros(10)
    hand, shoulder = arm.place(angles), arm.place(np.zeros(10))
    out = (hand - shoulder) / np.linalg.norm(hand - shoulder)
    steps = np.linspace(-0.03, 0.03, 61)
    actions = [arm.towards(angles, still, hand + s * out, lambda _: angles) for s in steps]
    assert np.abs(np.diff(actions, axis=0)).max() < 0.05


def follow(task, path, steps=80):
    """Hand and target of an episode in which the robot does nothing [m]."""
    world, handle = task.make_world(1, threads=1), task.make_handle()
    world.reset(np.array([0]))
    home, hands, targets = handle.place(world.snapshot()[0]), [], []
    for step in range(steps):
        state = world.snapshot()[0]
        hands.append(handle.place(state))
        targets.append(home + path(step * task.control_period))
        world.step(np.zeros((1, 7)), handle.towards(state, targets[-1])[None])
    return np.array(hands), np.array(targets)


def test_a_hand_comes_to_rest_at_a_target_that_it_can_reach(task):
    hands, targets = follow(task, lambda _: np.array([-0.05, -0.05, 0.1]), steps=40)
    assert np.linalg.norm(hands[-10:] - targets[-10:], axis=1).max() < 0.002
    beyond = (hands - targets[0]) @ (targets[0] - hands[0]) / np.linalg.norm(targets[0] - hands[0])
    assert beyond.max() < 0.015


def test_a_hand_follows_a_circle_a_quarter_of_a_second_late(task):
    """Of 10 cm radius, in 5 s."""

    def turn(time):
        angle = 0.4 * np.pi * time
        return 0.1 * np.array([-np.sin(angle), 0, 1 - np.cos(angle)])

    hands, targets = follow(task, turn)
    apart = [np.linalg.norm(hands[20:] - targets[20 - late : 80 - late], axis=1).mean()
             for late in range(6)]  # fmt: skip
    assert int(np.argmin(apart)) in (2, 3)
    assert min(apart) < 0.01
    assert apart[0] < 0.04

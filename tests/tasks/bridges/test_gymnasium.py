"""Gymnasium's environments with a person inside: the person is moved, seen, and sees."""

import re

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.naturalness.features import choose_features
from rigid.tasks.conformance import broken_promises
from rigid.tasks.registry import make_task
from rigid.tasks.views.ranged import with_range

HERE = "gymnasium:tests.tasks.bridges.environments"


def open_task(factory, **parameters):
    return make_task(f"{HERE}:{factory}", **parameters)


@pytest.mark.parametrize(("factory", "horizon"), [("room", None), ("ported", 6)])
def test_it_keeps_the_promises_of_a_task(factory, horizon):
    assert broken_promises(open_task(factory, **({"horizon": horizon} if horizon else {}))) == ()


def test_the_human_sees_how_it_moves_and_then_what_the_robot_sees():
    task = open_task("room")
    step = task.make_world(2, threads=1).reset(np.array([1, 2]))
    assert task.horizon == 5
    assert task.feature_names == ("place",)
    assert task.robot.observation_names == ("door_0", "door_1", "robot")  # As Gymnasium sorts.
    assert task.human.observation_names[0] == "place"
    np.testing.assert_array_equal(
        step.human_observation, np.hstack([step.features, step.robot_observation])
    )


def test_the_humans_action_is_applied_before_the_robots():
    task = open_task("room")
    world = task.make_world(1, threads=1)
    before = world.reset(np.array([3]))
    after = world.step(np.array([[0.5]]), np.array([[-1.0]]))
    person = before.features[0, 0] - 2.0
    assert after.features[0, 0] == pytest.approx(person, rel=1e-4)
    assert after.reward[0] == pytest.approx(-abs(0.5 - person), rel=1e-4)


@pytest.mark.parametrize("choice", ["observation", "observation+action"])
def test_what_is_held_after_an_early_end_is_not_judged(choice):
    task = open_task("room")
    message = f"features '{re.escape(choice)}' of .* cannot be judged.*: choose among place"
    for asked in (task, with_range(task, (-1, 0))):
        with pytest.raises(UserError, match=message):
            choose_features(choice, asked)
    assert choose_features("place", task).columns == (0,)


def test_a_port_says_what_the_human_sees():
    task = open_task("ported", horizon=6)
    step = task.make_world(1, threads=1).reset(np.array([3]))
    assert task.human.observation_size == 1
    assert task.feature_names == ("feature_0",)
    np.testing.assert_array_equal(step.human_observation, step.features)


def test_features_are_known_by_the_names_of_the_first_reset_not_by_their_order():
    world = open_task("reordering").make_world(1, threads=1)
    world.reset(np.array([3]))
    steps = [world.step(np.array([[-1.0]]), np.array([[0.0]])) for _ in range(2)]
    np.testing.assert_array_equal([step.features[0, 1] for step in steps], [1, 2])


@pytest.mark.parametrize(
    ("factory", "message"),
    [
        ("growing_body", r"at step 1 of the episode of seed 3: .*tail.* but were place, steps"),
        ("longer_row", r"at step 1 of .* it shows naturalness 2 numbers, but began with 1"),
    ],
)
def test_features_that_are_others_than_at_the_first_reset_are_refused(factory, message):
    world = open_task(factory).make_world(1, threads=1)
    world.reset(np.array([3]))
    with pytest.raises(UserError, match=message):
        world.step(np.array([[-1.0]]), np.array([[0.0]]))


def test_success_is_what_the_last_step_says():
    task = open_task("room")
    world = task.make_world(1, threads=1)
    world.reset(np.array([3]))
    for _ in range(5):
        world.step(np.array([[1.0]]), np.array([[-1.0]]))
    np.testing.assert_array_equal(world.summary().success, 0)


@pytest.mark.parametrize(
    ("factory", "message"),
    [
        ("ported", r"does not say how long an episode is"),
        ("unpeopled", r"cannot move the person in CartPoleEnv, which has no human_action_space"),
        ("two", r"gives a Line: give an environment with human_action_space"),
        ("nothing", r"gives a int: give an environment"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_cure(factory, message):
    with pytest.raises(UserError, match=message):
        open_task(factory)

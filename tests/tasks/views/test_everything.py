"""A robot that sees everything sees its own numbers first, then the human's."""

import numpy as np

from rigid.tasks.protocol import BoundedTask, Task, World
from rigid.tasks.registry import make_task
from rigid.tasks.views.everything import SeeingEverything
from tests.tasks.scripted import random_actions
from tests.toys import ToyReach


def test_the_robot_sees_the_humans_numbers_after_its_own(task):
    view = SeeingEverything(task)
    world, plain = view.make_world(3, threads=1), task.make_world(3, threads=1)
    assert isinstance(view, Task)
    assert isinstance(world, World)
    actions = random_actions(np.random.default_rng(0), 3)
    for step, expected in (
        (world.reset(np.arange(3)), plain.reset(np.arange(3))),
        (world.step(*actions), plain.step(*actions)),
    ):
        own = task.robot.observation_size
        np.testing.assert_array_equal(step.robot_observation[:, :own], expected.robot_observation)
        np.testing.assert_array_equal(step.robot_observation[:, own:], expected.human_observation)
        np.testing.assert_array_equal(step.human_observation, expected.human_observation)
        assert step.robot_observation.shape[1] == view.robot.observation_size
    np.testing.assert_array_equal(world.summary().outcome, plain.summary().outcome)
    np.testing.assert_array_equal(world.snapshot(), plain.snapshot())


def test_pace_and_units_are_the_tasks():
    task = make_task("itch-scratching")
    view = SeeingEverything(task)
    assert (view.control_period, view.feature_units) == (task.control_period, task.feature_units)


def test_bounds_are_those_of_what_is_seen_where_the_task_has_some(task):
    view = SeeingEverything(task)
    assert isinstance(view, BoundedTask)
    own, seen = task.bounds("robot"), view.bounds("robot")
    assert seen.shape == (view.robot.observation_size, 2)
    np.testing.assert_array_equal(seen, [*own, *task.bounds("human")])
    np.testing.assert_array_equal(view.bounds("human"), task.bounds("human"))
    assert not isinstance(SeeingEverything(ToyReach()), BoundedTask)


def test_its_description_is_not_that_of_the_task(task):
    assert SeeingEverything(task).describe() != task.describe()

"""The analytic tasks as tasks: steps by hand, policies by name, what they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.learning.rollout import play, policy_actor
from rigid.policies.loading import builtin_names, load_policy, policy_hash
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task, task_from_description

NAMES = ("analytic/offset-catch", "analytic/hand-tracking")


def canonical(task, robot, episodes=20_000):
    human = load_policy("builtin:synthetic-human", task=task, agent="human")
    actors = (
        policy_actor(load_policy(robot, task=task, agent="robot"), episodes, None),
        policy_actor(human, episodes, np.random.default_rng(0)),
    )
    return play(task, task.make_world(episodes), np.arange(episodes), *actors)


@pytest.mark.parametrize("name", NAMES)
def test_they_are_tasks_that_can_be_built_again(name):
    task = make_task(name)
    assert isinstance(task, Task)
    assert task.scene() is None
    assert task_from_description(task.describe()).describe() == task.describe()


@pytest.mark.parametrize("name", NAMES)
def test_their_forces_are_unknown(name):
    summary = make_task(name).make_world(2).summary()
    assert np.isnan([summary.peak_force, summary.impulse]).all()


def test_a_hand_over_by_hand():
    """The third hand goes no further than 8; the robot of the last one is in the way."""
    human, robot = np.array([[0.25], [0.375], [2.0], [0.375]]), np.zeros((4, 1))
    robot[3] = 0.25
    for cost, expected in (("linear", [-2, -3, -8, -1]), ("failure", [0, -1, -1, 0])):
        task = make_task("analytic/offset-catch", cost=cost, tolerance=2)
        world = task.make_world(4)
        world.reset(np.arange(4))
        step = world.step(robot, human)
        assert step.reward.tolist() == expected
        assert task.features(step)[:, 0].tolist() == [2, 3, 8, 3]
        assert world.summary().success.tolist() == [1, 0, 0, 1]
        assert world.summary().outcome.tolist() == [0, 1, 1, 0]


def test_tracking_by_hand():
    task = make_task("analytic/hand-tracking")
    world = task.make_world(1)
    world.reset(np.arange(1))
    first = world.step(np.zeros((1, 1)), np.array([[0.1]]))
    assert first.reward == pytest.approx([-0.04])
    assert first.features[0] == pytest.approx([0.0, 0.2])
    tracker = load_policy("builtin:tracker", task=task, agent="robot")
    action, _ = tracker.act(first.robot_observation, (), None)
    second = world.step(action, np.array([[0.15]]))
    assert second.human_observation[0] == pytest.approx([0.5 * 0.2 + 0.3])
    assert second.features[0] == pytest.approx([0.2, 0.3])
    again = world.reset(np.arange(1))
    assert again.human_observation[0].tolist() == [0.0]


def test_canonical_offsets_are_standard_normal():
    x = canonical(make_task("analytic/offset-catch"), "builtin:catcher").features
    assert (x.mean(), x.std()) == pytest.approx((0.0, 1.0), abs=0.02)
    assert np.abs(x).max() < 8


@pytest.mark.parametrize(("gain", "cost"), [(0.5, 0.262222), (0.2, 0.506179)])
def test_canonical_tracking_costs_what_the_formula_says(gain, cost):
    task = make_task("analytic/hand-tracking", gain=gain)
    assert -canonical(task, "builtin:tracker").returns.mean() == pytest.approx(cost, rel=0.02)


def test_exact_policies_have_names_and_hashes():
    task = make_task("analytic/hand-tracking")
    assert builtin_names(task, "robot") == ("tracker",)
    assert builtin_names(task, "human") == ("passive", "synthetic-human")
    one, same = (load_policy("builtin:tracker", task=task, agent="robot") for _ in range(2))
    slow = make_task("analytic/hand-tracking", gain=0.2)
    other = load_policy("builtin:tracker", task=slow, agent="robot")
    assert policy_hash(one) == policy_hash(same) != policy_hash(other)
    with pytest.raises(UserError, match=r"'builtin:traker' is unknown .* builtin:tracker"):
        load_policy("builtin:traker", task=task, agent="robot")


@pytest.mark.parametrize(
    ("name", "parameters", "message"),
    [
        (NAMES[0], {"cost": "square"}, r"cost is 'square', but must be one of linear, failure"),
        (NAMES[0], {"tolerance": 8.0}, r"tolerance is 8\.0, but must be .* less than 8"),
        (NAMES[1], {"gain": 0.0}, r"gain is 0\.0, but must be more than 0, at most 1"),
    ],
)
def test_parameters_without_sense_are_refused(name, parameters, message):
    with pytest.raises(UserError, match=message):
        make_task(name, **parameters)

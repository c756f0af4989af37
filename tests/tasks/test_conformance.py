"""The check of a task finds what it is there to find, and nothing in RIGID's own tasks."""

import threading

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.tasks.conformance import broken_promises, check_task
from rigid.tasks.protocol import AgentSpec
from rigid.tasks.registry import make_task, task_names
from tests.toys import ToyReach, ToyWorld


@pytest.mark.parametrize("name", task_names())
def test_tasks_of_rigid_keep_their_promises(name):
    assert broken_promises(make_task(name)) == ()


class Broken(ToyReach):
    """A sound task, but for its worlds."""

    def __init__(self, world):
        super().__init__(name="broken")
        self._world = world

    def make_world(self, batch, *, threads=0):
        del threads
        return self._world(self, batch)


class Forgetful(ToyWorld):
    """Starts elsewhere each time, whatever the seed."""

    _side = 1.0

    def reset(self, seeds):
        super().reset(seeds)
        self._side = -self._side
        self._goal *= self._side
        return self._look(np.zeros(self.batch))


class Unclipped(ToyWorld):
    def step(self, robot_action, human_action):
        step = super().step(robot_action, human_action)
        return step._replace(reward=step.reward + np.abs(robot_action[:, 0]))


class Recycling(ToyWorld):
    """Gives the same array at every step."""

    def reset(self, seeds):
        self._array = np.zeros((self.batch, 2))
        return super().reset(seeds)._replace(robot_observation=self._array)

    def step(self, robot_action, human_action):
        self._array += 1
        return super().step(robot_action, human_action)._replace(robot_observation=self._array)


class Misshapen(ToyWorld):
    def step(self, robot_action, human_action):
        step = super().step(robot_action, human_action)
        return step._replace(features=step.features[:, :1])


class Runaway(ToyWorld):
    def step(self, robot_action, human_action):
        step = super().step(robot_action, human_action)
        return step._replace(reward=step.reward * np.nan)


class Boastful(ToyWorld):
    def summary(self):
        return super().summary()._replace(success=np.full(self.batch, 2.0))


class Moody(ToyWorld):
    """Measures nothing after a reset, which is its right, and something else at every step."""

    def reset(self, seeds):
        self._steps = 0
        return super().reset(seeds)._replace(info={})

    def step(self, robot_action, human_action):
        self._steps += 1
        step = super().step(robot_action, human_action)
        return step._replace(info={f"mood_{self._steps % 2}": np.zeros(self.batch)})


@pytest.mark.parametrize(
    ("world", "message"),
    [
        (Forgetful, "of step 0 depends on more than seed and actions: begun again in the same"),
        (
            Unclipped,
            "reward of step 1 depends on more .* beyond \\[-1, 1\\], which must be clipped",
        ),
        (Recycling, "robot_observation of an earlier step changes with the next one: return cop"),
        (Misshapen, r"features has shape \(3, 1\) after a step, but must have \(3, 2\)"),
        (Runaway, "reward is not finite after a step; a world that runs away sets faulted"),
        (Boastful, "success must be 0, 1 or NaN"),
        (Moody, "info changes its names: mood_0, mood_1"),
    ],
)
def test_a_world_that_breaks_a_promise_is_told_which(world, message):
    with pytest.raises(UserError, match=f"task 'broken' breaks its promises:\n.*{message}"):
        check_task(Broken(world))


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("horizon", 0, "horizon is 0"),
        ("feature_names", ("a", "a"), "feature_names must be distinct"),
        ("return_range", (1.0, 0.0), "return_range must be"),
        ("outcome_names", (), "outcome_names is empty"),
        ("robot", AgentSpec(2, 1, ("one",)), "1 observation_names for 2 numbers"),
        ("human", AgentSpec(3, 3, (), (2, 2)), "choices \\(2, 2\\) do not add up to action_size 3"),
        ("describe", lambda: {"name": np.zeros(2)}, "describe\\(\\) is no JSON"),
    ],
)
def test_a_form_that_breaks_a_promise_is_told(name, value, message):
    task = ToyReach()
    setattr(task, name, value)
    with pytest.raises(UserError, match=message):
        check_task(task)


def test_a_task_that_cannot_be_sent_is_told():
    task = ToyReach()
    task.lock = threading.Lock()
    with pytest.raises(UserError, match="cannot be sent to other processes"):
        check_task(task)


def test_what_is_no_task_is_told_what_it_lacks():
    with pytest.raises(UserError, match=r"a int lacks describe, feature_names, features"):
        check_task(5)

"""A task whose steps are told of: the same task, and no step is told twice or left out."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.tasks.analytic.hand_tracking import HandTracking
from rigid.tasks.protocol import BringsPolicies, Task, World
from rigid.tasks.views import watched as module
from rigid.tasks.views.watched import WatchedWorld, watched

STILL = np.zeros((3, 1))


@pytest.fixture
def told():
    return []


@pytest.fixture
def world(told):
    return WatchedWorld(HandTracking().make_world(3), told.append)


def played(world, steps):
    world.reset(np.arange(3))
    return [world.step(STILL, STILL).reward.tolist() for _ in range(steps)]


def test_it_is_the_same_task(told):
    task = HandTracking()
    seen = watched(task, told.append)
    assert isinstance(seen, Task)
    assert isinstance(seen, BringsPolicies)
    assert isinstance(seen.make_world(3), World)
    assert seen.describe() == task.describe()
    assert seen.return_range == task.return_range
    assert played(seen.make_world(3), 5) == played(task.make_world(3), 5)


def test_quick_steps_are_told_together_when_asked(world, told):
    played(world, 5)
    assert told == []
    world.tell_all()
    world.tell_all()
    assert told == [15]


def test_slow_steps_are_told_as_they_are_done(told):
    world = watched(HandTracking(), told.append, seconds=0.0).make_world(3)
    played(world, 2)
    assert told == [3, 3]


def test_time_between_episodes_is_no_time_of_a_step(world, told, monkeypatch):
    now = 0.0
    monkeypatch.setattr(module.time, "monotonic", lambda: now)
    now = 100.0
    played(world, 2)
    assert told == []

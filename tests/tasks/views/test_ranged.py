"""A task with another range: the same in everything else."""

from __future__ import annotations

import inspect

import cloudpickle
import numpy as np
import pytest

from rigid.errors import UserError
from rigid.tasks.analytic.hand_tracking import HandTracking
from rigid.tasks.protocol import BringsPolicies, DrawsFeatures, Task, VariesHumans
from rigid.tasks.registry import make_task
from rigid.tasks.views.ranged import with_range
from tests.toys import ToyReach


@pytest.fixture
def ranged():
    return with_range(HandTracking(), (-10, 5))


def test_it_has_the_given_range_and_the_task_keeps_its_own():
    task = HandTracking()
    assert with_range(task, (-10, 5)).return_range == (-10.0, 5.0)
    assert task.return_range == (-2.5, 0.0)


def test_everything_else_is_the_task(ranged):
    task = HandTracking()
    assert isinstance(ranged, Task)
    assert ranged.describe() == task.describe()
    assert (ranged.name, ranged.horizon, ranged.human) == (task.name, task.horizon, task.human)
    assert ranged.gain == task.gain
    step = ranged.make_world(2).reset(np.arange(2))
    np.testing.assert_array_equal(ranged.features(step), task.features(step))


def test_it_keeps_the_optional_protocols_of_the_task_and_no_others(ranged):
    assert isinstance(ranged, BringsPolicies)
    assert set(ranged.builtin_policies("robot")) == {"tracker"}
    assert not isinstance(ranged, VariesHumans | DrawsFeatures)
    assert not isinstance(with_range(ToyReach(), (-1, 0)), BringsPolicies)


def test_it_says_of_itself_what_the_task_says_and_not_only_when_asked():
    view = with_range(make_task("itch-scratching"), (-100, 0))
    for name in ("control_period", "feature_units", "bounds"):  # Python 3.12 looks here alone.
        assert inspect.getattr_static(view, name) == getattr(view._task, name)


def test_it_survives_a_journey_to_another_process(ranged):
    again = cloudpickle.loads(cloudpickle.dumps(ranged))
    assert again.return_range == (-10.0, 5.0)
    assert again.describe() == ranged.describe()


@pytest.mark.parametrize("range_", [(1, 1), (2, 1), (float("nan"), 1), (0, float("inf"))])
def test_what_is_no_range_is_refused(range_):
    with pytest.raises(UserError, match=r"but must be two returns LOW,HIGH with LOW < HIGH"):
        with_range(HandTracking(), range_)


def test_what_neither_has_is_missing(ranged):
    with pytest.raises(AttributeError, match="nothing"):
        ranged.nothing  # noqa: B018  # The access is what is tested.

"""What a study may vary in every task, and what is said to values that make no sense."""

import json
from dataclasses import FrozenInstanceError

import pytest

from rigid.errors import UserError
from rigid.tasks.registry import make_task, task_from_description

BAD = [
    ({"percentile": 99}, "percentile is 99, but must be in [5, 95]"),
    ({"percentile": float("nan")}, "percentile is nan, but must be in [5, 95]"),
    ({"percentile": "tall"}, "a parameter has the wrong type"),
    ({"severity": -0.1}, "severity is -0.1, but must be in [0, 1]"),
    ({"impairment": "pain"}, "impairment is 'pain', but must be one of "),
    ({"horizon": 0}, "horizon is 0, but must be at least 1 step"),
    ({"physics_step": 0.05}, "physics_step is 0.05, but must be in (0, 0.02] s"),
    ({"substeps": 0}, "substeps is 0, but must be at least 1"),
    ({"weights": {"action": -1}}, "weights.action is -1, but must be a number from 0 on"),
    ({"weights": {"actoin": 1}}, "unknown weight 'actoin', did you mean 'action'?"),
    ({"bodi": "male"}, "unknown parameter 'bodi', did you mean 'body'?"),
]


@pytest.mark.parametrize(("parameters", "message"), BAD, ids=[f"{bad}" for bad, _ in BAD])
def test_a_bad_value_is_named_with_the_cure(case, parameters, message):
    with pytest.raises(UserError) as error:
        make_task(case.name, **parameters)
    assert str(error.value).startswith(f"{case.name}: {message}")


def test_a_bad_value_of_its_own_parameters_is_named_as_well(case):
    parameters, message = case.wrong
    with pytest.raises(UserError) as error:
        make_task(case.name, **parameters)
    assert str(error.value) == f"{case.name}: {message}"


def test_a_task_can_be_built_again_from_its_description(case, task):
    described = make_task(case.name, body="female", weights={case.weight: 1.0}).describe()
    again = task_from_description(json.loads(json.dumps(described)))
    assert type(again) is type(task)
    assert again.describe() == described
    assert getattr(again.parameters.weights, case.weight) == 1.0


def test_a_description_tells_tasks_apart(task):
    assert task.describe() != task.with_parameters(body="female").describe()
    assert task.describe() == task.with_parameters(body="male").describe()


def test_parameters_cannot_change_under_a_task(task):
    with pytest.raises(FrozenInstanceError):
        task.parameters.horizon = 7


def test_the_original_timing_is_the_default(task):
    assert task.parameters.physics_step * task.parameters.substeps == pytest.approx(0.1)

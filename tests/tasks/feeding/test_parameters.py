"""What a study may vary, and what is said to values that make no sense."""

import pytest

from rigid.errors import UserError
from rigid.tasks.feeding.task import Feeding
from rigid.tasks.registry import make_task, task_from_description

BAD = [
    ({"percentile": 99}, "percentile is 99, but must be in [5, 95]"),
    ({"severity": 2}, "severity is 2, but must be in [0, 1]"),
    ({"head_start_deg": 45}, "head_start_deg is 45, but must be in [0, 30]"),
    ({"horizon": 0}, "horizon is 0, but must be at least 1 step"),
    ({"weights": {"food": -1}}, "weights.food is -1, but must be a number from 0 on"),
    ({"weights": {"fod": 1}}, "unknown weight 'fod', did you mean 'food'?"),
    ({"bodi": "male"}, "unknown parameter 'bodi', did you mean 'body'?"),
    ({"percentile": "tall"}, "a parameter has the wrong type"),
]


@pytest.mark.parametrize(("parameters", "message"), BAD, ids=[f"{bad}" for bad, _ in BAD])
def test_a_bad_value_is_named_with_the_cure(parameters, message):
    with pytest.raises(UserError) as error:
        make_task("feeding", **parameters)
    assert str(error.value).startswith(f"feeding: {message}")


def test_a_task_can_be_built_again_from_its_description():
    described = make_task("feeding", body="female", weights={"spill": 1.0}).describe()
    again = task_from_description(described)
    assert isinstance(again, Feeding)
    assert again.describe() == described
    assert again.parameters.weights.spill == 1.0


@pytest.mark.parametrize("parameters", [
    {"body": "female", "percentile": 5.0}, {"percentile": 95.0}, {"servo": "datasheet"},
])  # fmt: skip
def test_every_body_leaves_clear_starts(parameters):
    assert len(Feeding().with_parameters(**parameters).starts) >= 16

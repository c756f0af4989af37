"""What a study may vary, and what is said to values that make no sense."""

import pytest

from rigid.errors import UserError
from rigid.tasks.bed_bathing.task import BedBathing
from rigid.tasks.registry import make_task, task_from_description

BAD = [
    ({"percentile": 99}, "percentile is 99, but must be in [5, 95]"),
    ({"arm_start_deg": 45}, "arm_start_deg is 45, but must be in [0, 10]"),
    ({"horizon": 0}, "horizon is 0, but must be at least 1 step"),
    ({"weights": {"wipe": -1}}, "weights.wipe is -1, but must be a number from 0 on"),
    ({"weights": {"wip": 1}}, "unknown weight 'wip', did you mean 'wipe'?"),
    ({"bodi": "male"}, "unknown parameter 'bodi', did you mean 'body'?"),
    ({"percentile": "tall"}, "a parameter has the wrong type"),
]


@pytest.mark.parametrize(("parameters", "message"), BAD, ids=[f"{bad}" for bad, _ in BAD])
def test_a_bad_value_is_named_with_the_cure(parameters, message):
    with pytest.raises(UserError) as error:
        make_task("bed-bathing", **parameters)
    assert str(error.value).startswith(f"bed-bathing: {message}")


def test_a_task_can_be_built_again_from_its_description():
    described = make_task("bed-bathing", body="female", weights={"wipe": 1.0}).describe()
    again = task_from_description(described)
    assert isinstance(again, BedBathing)
    assert again.describe() == described
    assert again.parameters.weights.wipe == 1.0


@pytest.mark.parametrize("parameters", [
    {"body": "female", "percentile": 5.0}, {"percentile": 95.0}, {"servo": "datasheet"},
])  # fmt: skip
def test_every_body_leaves_clear_starts(parameters):
    assert len(BedBathing().with_parameters(**parameters).starts) >= 16

"""What a study may vary, and what is said to values that it may not take."""

import json
import runpy
from dataclasses import FrozenInstanceError

import pytest

from rigid.errors import UserError
from rigid.tasks.itch_scratching import parameters
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters, RewardWeights

# As users run it: the type checker of the tests would refuse some values first.
UNCHECKED = runpy.run_path(parameters.__file__)["ItchScratchingParameters"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"body": "child"}, r"body is 'child', but must be one of \['female', 'male'\]"),
        ({"percentile": 99.0}, r"percentile is 99.0, but must be in \[5, 95\]"),
        ({"percentile": float("nan")}, r"percentile is nan, but must be in \[5, 95\]"),
        ({"severity": -0.1}, r"severity is -0.1, but must be in \[0, 1\]"),
        ({"impairment": "pain"}, "impairment is 'pain', but must be one of .*'tremor'"),
        ({"itch_limbs": ("nose",)}, "itch_limbs is .*'nose'.* one or both of .*'upper_arm'"),
        ({"itch_limbs": ()}, r"itch_limbs is \(\), but must be one or both of"),
        ({"itch_spread": 1.5}, r"itch_spread is 1.5, but must be in \[0, 1\]"),
        ({"servo": "strong"}, "servo is 'strong', but must be paper or datasheet"),
        ({"horizon": 0}, "horizon is 0, but must be at least 1 step"),
        ({"physics_step": 0.05}, r"physics_step is 0.05, but must be in \(0, 0.02\] s"),
        (
            {"weights": RewardWeights(scratch=-1.0)},
            r"weights\.scratch is -1.0, but must be a",
        ),
        ({"weights": RewardWeights(action=float("nan"))}, r"weights\.action is nan, but must be"),
        ({"substeps": 0}, "substeps is 0, but must be at least 1"),
    ],
)
def test_a_bad_value_is_named_with_its_cure(changes, message):
    with pytest.raises(UserError, match=f"^itch-scratching: {message}"):
        UNCHECKED(**changes)


def test_the_original_timing_is_the_default():
    default = ItchScratchingParameters()
    assert default.physics_step * default.substeps == pytest.approx(0.1)
    assert default.horizon == 100


def test_parameters_cannot_change_under_a_task():
    with pytest.raises(FrozenInstanceError):
        ItchScratchingParameters().horizon = 7


def test_the_description_of_a_task_is_json_and_tells_tasks_apart(task):
    other = task.with_parameters(body="female")
    assert json.loads(json.dumps(task.describe()))["parameters"]["body"] == "male"
    assert task.describe() != other.describe()
    assert task.describe() == task.with_parameters(body="male").describe()


def test_seeing_the_itch_changes_what_the_robot_sees_and_nothing_else(task):
    seeing = task.seeing_the_itch()
    assert seeing.parameters == task.parameters
    assert seeing.robot.observation_names[: task.robot.observation_size] == (
        task.robot.observation_names
    )
    assert seeing.human == task.human

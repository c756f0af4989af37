"""What a study may choose from a list, and what seeing the itch changes."""

import runpy

import pytest

from rigid.errors import UserError
from rigid.tasks.itch_scratching import parameters

# As users run it: the type checker of the tests would refuse these values first.
UNCHECKED = runpy.run_path(parameters.__file__)["ItchScratchingParameters"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"body": "child"}, r"body is 'child', but must be one of \['female', 'male'\]"),
        ({"servo": "strong"}, "servo is 'strong', but must be paper or datasheet"),
        ({"itch_limbs": ("nose",)}, "itch_limbs is .*'nose'.* one or both of .*'upper_arm'"),
        ({"itch_limbs": ()}, r"itch_limbs is \(\), but must be one or both of"),
        (
            {"weights": parameters.RewardWeights(action=float("nan"))},
            r"weights\.action is nan, but must be",
        ),
    ],
)
def test_a_bad_value_is_named_with_its_cure(changes, message):
    with pytest.raises(UserError, match=f"^itch-scratching: {message}"):
        UNCHECKED(**changes)


def test_seeing_the_itch_changes_what_the_robot_sees_and_nothing_else(task):
    seeing = task.seeing_the_itch()
    assert seeing.parameters == task.parameters
    assert seeing.robot.observation_names[: task.robot.observation_size] == (
        task.robot.observation_names
    )
    assert seeing.human == task.human

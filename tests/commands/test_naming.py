"""Tests of `rigid.commands.naming`."""

import pytest

from rigid.commands.naming import TaskOptions
from rigid.errors import UserError


@pytest.mark.parametrize(
    ("given", "option"),
    [({"human_agent": "agent_0"}, "human-agent"), ({"horizon": 7}, "horizon")],
)
def test_an_option_that_the_task_does_not_take_is_named_as_it_was_written(given, option):
    (value,) = given.values()
    options = TaskOptions(task="analytic/hand-tracking", **given)
    message = f"^--{option} {value}: analytic/hand-tracking takes no {option}, leave the option out"
    with pytest.raises(UserError, match=message):
        options.open_task()


def test_a_length_to_which_the_frozen_range_does_not_belong_is_refused():
    options = TaskOptions(task="itch-scratching", horizon=5)
    message = r"^--horizon 5: an episode of itch-scratching has 100 steps, to which its range"
    with pytest.raises(UserError, match=message):
        options.open_task()
    assert TaskOptions(task="itch-scratching", horizon=100).open_task().horizon == 100

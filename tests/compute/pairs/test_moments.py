"""The moment that people see as a still: one rule for every member of every pair."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid.compute.pairs.moments import deviation, moment, people_in, rule_text
from rigid.errors import UserError
from tests.toys import ToyReach

PERSON = frozenset({7})


def replay(places, robot=0.0, **series):
    """A hand (body 7) at these places on a line, and a robot (body 3) elsewhere."""
    poses = np.zeros((len(places), 2, 7))
    poses[:, 0, 0], poses[:, 1, 0] = robot, places
    return {"bodies": [3, 7], "poses": poses, **series}


CANONICAL = replay([0.0, 1.0, 2.0], robot=50.0)


def test_a_still_shows_the_greatest_deviation_from_the_nearest_moment_of_the_reference():
    assert moment(replay([0.0, 2.1, 1.5, 1.0]), CANONICAL, PERSON, "faithfulness") == (
        2, "deviation",
    )  # fmt: skip


def test_being_slower_is_no_deviation():
    slow = replay([0.0, 0.0, 1.0, 1.0, 2.0])
    assert moment(slow, CANONICAL, PERSON, "naturalness").step == 0


def test_a_dangerous_still_shows_the_greatest_unwanted_force():
    hit = replay([0.0, 9.0, 0.0], force_unwanted=[0.0, 1.0, 3.0])
    assert moment(hit, CANONICAL, PERSON, "danger") == (2, "force")
    assert moment(hit, CANONICAL, PERSON, "naturalness") == (1, "deviation")


@pytest.mark.parametrize("series", [{}, {"force_unwanted": [0.0, 0.0, 0.0]}])
def test_without_unwanted_force_danger_is_shown_at_the_greatest_deviation(series):
    assert moment(replay([0.0, 9.0, 0.0], **series), CANONICAL, PERSON, "danger") == (
        1, "deviation",
    )  # fmt: skip


@given(st.permutations(range(5)))
def test_the_order_of_the_reference_is_irrelevant(order):
    rng = np.random.default_rng(0)
    shown, reference = rng.standard_normal((4, 2, 3)), rng.standard_normal((5, 2, 3))
    np.testing.assert_allclose(
        deviation(shown, reference[list(order)]), deviation(shown, reference)
    )


@pytest.mark.parametrize("kind", ["naturalness", "faithfulness"])
def test_only_danger_asks_for_force(kind):
    assert "force" not in rule_text(kind)
    assert "greatest unwanted force" in rule_text("danger")


def test_a_task_that_draws_nothing_is_refused():
    with pytest.raises(UserError, match="'toy-reach' draws nothing of an episode"):
        people_in(ToyReach())

"""The unit of work: names, randomness, and when training counts as converged."""

from __future__ import annotations

import math

import pytest

from rigid.compute.search.convergence import convergence
from rigid.compute.search.group import json_lambda
from rigid.compute.search.group_plan import GroupPlan

PLAN = GroupPlan(seed=3, round=2, lambdas=(0.1, math.inf))


def test_names_say_seed_round_and_place():
    assert PLAN.name == "s3-r2"
    assert [PLAN.member(0), PLAN.member(1)] == ["s3-r2-l1", "s3-r2-l2"]


def test_every_group_has_randomness_of_its_own():
    plans = [GroupPlan(seed, number, (0.1,)) for seed in range(20) for number in (1, 2, 3)]
    assert len({plan.entropy for plan in plans}) == len(plans)


def test_randomness_does_not_depend_on_the_lambdas():
    assert GroupPlan(3, 2, (1.0,)).entropy == PLAN.entropy


def test_infinity_is_a_word_in_json():
    assert [json_lambda(value) for value in PLAN.lambdas] == [0.1, "inf"]


def history(returns, accuracy=1.0):
    return [
        {"mean_return": value, "accuracy_canonical": accuracy, "accuracy_adversary": 0.5,
         "entropy": -1.0}
        for value in returns
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("returns", "accuracy", "converged"),
    [
        ([0.0] * 40 + [-5.0, -5.1, -5.0, -5.1, -5.0, -5.1, -5.0, -5.1, -5.0, -5.1], 1.0, True),
        ([-0.5 * number for number in range(50)], 1.0, False),
        ([-5.0] * 50, 0.4, False),
        ([-5.0, -5.0], 1.0, True),
        ([-5.0], 1.0, False),
    ],
    ids=["at rest", "still falling", "discriminator collapsed", "two iterations", "one"],
)
def test_training_has_converged_when_its_end_is_at_rest(returns, accuracy, converged):
    assert convergence(history(returns, accuracy))["converged"] is converged


def test_a_single_iteration_has_no_drift():
    assert convergence(history([-5.0]))["return_drift"] is None

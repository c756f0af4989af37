"""Gates: what passes, and what must fail."""

from __future__ import annotations

import pytest

from rigid.compute.referee.verdict import Gate, Verdict, ends_gates, planted_gates
from rigid.naturalness.gates import Planted, exact_overlap
from rigid.naturalness.panel import LEVEL_NAMES

GOOD = Gate("canonical against itself", "step_k4", 0.99, 0.97, at_least=True)
BAD = Gate("sabotage reads 0", "step_k4", 0.2, 0.05, at_least=False)
BAD_WINDOW = Gate("sabotage reads 0", "window16_k4", 0.2, 0.05, at_least=False)


def point(**levels):
    return {"naturalness_all": {**dict.fromkeys(LEVEL_NAMES), **levels}}


def planted(*found):
    shifts = (1.0, 2.0, 3.0)
    exact = [exact_overlap(shift, 4.0) for shift in shifts]
    return [Planted("step_k4", *row) for row in zip(shifts, exact, found, strict=True)]


def test_the_worst_sabotage_and_the_mean_of_the_largest_lambda_count():
    low = [point(step_k4=0.01), point(step_k4=0.08)]
    high = [point(step_k4=0.6), point(step_k4=0.9)]
    sabotage, natural = ends_gates(low, high)
    assert (sabotage.measured, sabotage.passed) == (0.08, False)
    assert (natural.measured, natural.passed) == (0.75, True)


@pytest.mark.parametrize(
    ("found", "passed"),
    [
        ((0.94, 0.57, 0.26), [True, True]),
        ((0.94, 0.64, 0.26), [False, True]),
        ((0.56, 0.57, 0.26), [False, False]),
    ],
    ids=["right", "one too natural", "more shift reads as less"],
)
def test_planted_shifts_must_be_read_right_and_in_order(found, passed):
    assert [gate.passed for gate in planted_gates(planted(*found))] == passed


def test_only_gates_of_the_axis_fail_the_check():
    verdict = Verdict((GOOD, BAD_WINDOW), {})
    assert verdict.failed == ()
    described = verdict.describe()
    assert described["passed"]
    assert described["may_be_axis"] == {"step_k4": True, "window16_k4": False}

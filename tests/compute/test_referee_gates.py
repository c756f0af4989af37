"""Gates: what passes, what must fail, and who is refused."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.commands.refereeing import table
from rigid.compute import referee_gates
from rigid.compute.referee_gates import Gate, Verdict, _ends_gates, planted_gates
from rigid.naturalness.gates import Bench, Planted, Sizes, canonical_splits, exact_overlap
from rigid.naturalness.panel import LEVEL_NAMES
from rigid.naturalness.referee import RefereeSettings

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
    sabotage, natural = _ends_gates(low, high)
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


def test_the_table_names_the_gate_that_failed():
    text = table(Verdict((GOOD, BAD), {}))
    assert "the x axis, step_k4, FAILS: sabotage reads 0; do not believe" in text
    assert "levels that pass every gate: none" in text


def test_canonical_splits_of_white_noise_pass():
    canonical = np.random.default_rng(0).standard_normal((44, 20, 2)).astype(np.float32)
    settings = RefereeSettings(hidden=(8,), window_hidden=(8,), blocks=4)
    bench = Bench(Sizes(8, 8, 4, 8), settings)
    found = [values["step_k4"] for values in canonical_splits(canonical, bench, splits=3)]
    assert np.mean(found) >= 0.97


def failing(subject, preset, *, out, listener):
    del subject, preset, listener
    out.mkdir(parents=True, exist_ok=True)
    return Verdict((GOOD, BAD), {})


def test_the_command_exits_with_1_when_a_gate_of_the_axis_fails(monkeypatch, capsys, tmp_path):
    from rigid.cli import run

    monkeypatch.setattr(referee_gates, "check_referee", failing)
    assert run(["referee", "--check", "--out", str(tmp_path)]) == 1
    assert "FAILS: sabotage reads 0" in capsys.readouterr().out


def test_without_check_there_is_nothing_to_do(capsys):
    from rigid.cli import run

    assert run(["referee"]) == 2
    assert "rigid referee has nothing to do: give --check" in capsys.readouterr().err

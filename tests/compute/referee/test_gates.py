"""The check of the referee: what it measures, what it says, and who is refused."""

from __future__ import annotations

import numpy as np

from rigid.commands.refereeing import table
from rigid.compute.referee import gates as referee_gates
from rigid.compute.referee.verdict import Verdict
from rigid.naturalness.gates import Bench, Sizes, canonical_splits
from rigid.naturalness.referee import RefereeSettings
from tests.compute.referee.test_verdict import BAD, GOOD


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

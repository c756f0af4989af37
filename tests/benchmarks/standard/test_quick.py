"""The command line, and the whole study, small."""

from __future__ import annotations

import csv
import json
import shutil
import subprocess

import pytest

from benchmarks.standard.__main__ import main
from tests.benchmarks.quick import ROOT, quick_run


@pytest.mark.slow
def test_a_quick_run_goes_from_training_to_the_account_and_goes_on_elsewhere(tmp_path):
    results = tmp_path / "results"
    first = quick_run("standard", tmp_path / "here", "--results", str(results))
    assert first.returncode == 0, first.stderr
    names = ("README.md", "costs.csv", "figure.svg", "seeds.csv", "table.csv")
    with (results / "seeds.csv").open() as file:
        assert len(list(csv.DictReader(file))) == 2 * 2 * 5  # Robots, seeds, numbers.
    kept = results / "runs" / "i001-s1" / "paper" / "seed-1" / "settings.json"
    assert json.loads(kept.read_text())["seeds"] == [1]
    before = {name: (results / name).read_bytes() for name in names}
    again = quick_run("standard", tmp_path / "there", "--results", str(results))
    assert again.returncode == 0, again.stderr
    assert "0 of 8 measurements to go" in again.stdout
    assert "measured:" not in again.stdout
    assert {name: (results / name).read_bytes() for name in names} == before


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        pytest.param(["--seeds", "one"], "--seeds 'one'", id="seeds"),
        pytest.param(["--for", "soon"], "--for 'soon': write a time as 90s", id="for"),
    ],
)
def test_what_cannot_be_read_is_refused_before_any_work(capsys, arguments, message):
    assert main(arguments) == 2
    assert message in capsys.readouterr().err


def test_make_help_lists_it():
    command = [shutil.which("make"), "help"]
    listed = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    assert "\nbench-standard  holds preset standard against preset paper" in listed.stdout

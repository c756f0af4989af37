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
def test_a_quick_run_goes_from_training_to_the_account_and_goes_on_at_once(tmp_path):
    first = quick_run("standard", tmp_path)
    assert first.returncode == 0, first.stderr
    results = tmp_path / "results"
    names = {path.name for path in results.iterdir()}
    assert names == {"README.md", "costs.csv", "figure.svg", "seeds.csv", "table.csv"}
    with (results / "seeds.csv").open() as file:
        assert len(list(csv.DictReader(file))) == 2 * 2 * 5  # Robots, seeds, numbers.
    settings = json.loads((tmp_path / "i001-s1" / "paper" / "settings.json").read_text())
    assert settings["seeds"] == [0, 1]
    before = {name: (results / name).read_bytes() for name in names}
    again = quick_run("standard", tmp_path)
    assert "0 of 8 measurements to go" in again.stdout
    assert "measured:" not in again.stdout
    assert {name: (results / name).read_bytes() for name in names} == before


def test_seeds_that_cannot_be_read_are_refused_before_any_work(capsys):
    assert main(["--seeds", "one"]) == 2
    assert "--seeds 'one'" in capsys.readouterr().err


def test_make_help_lists_it():
    command = [shutil.which("make"), "help"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert "\nbench-standard  holds preset standard against preset paper" in listed.stdout

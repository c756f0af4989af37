"""The whole road of the planted study, with tiny budgets."""

from __future__ import annotations

import subprocess
import sys

import pytest

from benchmarks.planted.plan import QUICK


def test_every_method_ends_with_as_many_humans_as_the_plan_says():
    assert QUICK.sharing.natural_slots == QUICK.humans == 3
    assert QUICK.steps == 3 * QUICK.iterations * QUICK.episodes * 40


@pytest.mark.slow
def test_the_quick_road_writes_table_figure_and_account_and_resumes(tmp_path):
    pytest.importorskip("ribs")
    command = [
        sys.executable, "-m", "benchmarks.planted", "--quick",
        "--out", str(tmp_path / "runs"), "--results", str(tmp_path / "results"),
    ]  # fmt: skip
    subprocess.run(command, check=True)
    first = {path.name: path.read_bytes() for path in (tmp_path / "results").iterdir()}
    assert set(first) == {"table.csv", "figure.svg", "README.md"}
    again = subprocess.run(command, check=True, capture_output=True, text=True)
    assert "against" not in again.stdout
    assert {path.name: path.read_bytes() for path in (tmp_path / "results").iterdir()} == first

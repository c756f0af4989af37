"""The whole study, small."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.slow
def test_a_quick_run_leaves_everything_and_goes_on_at_once(tmp_path):
    def run():
        command = [sys.executable, "-m", "benchmarks.coverage", "--quick", "--out", str(tmp_path)]
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)

    first = run()
    assert first.returncode == 0, first.stderr
    results = tmp_path / "results"
    names = {path.name for path in results.iterdir()}
    assert names == {"README.md", "figure.svg", "seeds.csv", "table.csv"}
    with (results / "seeds.csv").open() as file:
        assert len(list(csv.DictReader(file))) == 2 * 4
    before = (results / "table.csv").read_bytes()
    again = run()
    assert again.stdout.count("is already complete; nothing to do") == 2
    assert (results / "table.csv").read_bytes() == before

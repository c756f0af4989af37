"""The whole study, small."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.slow
def test_a_quick_run_draws_everything_anew_and_goes_on_at_once(tmp_path):
    def run():
        command = [sys.executable, "-m", "benchmarks.reliability", "--quick", "--out", tmp_path]
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)

    first = run()
    assert first.returncode == 0, first.stderr
    results = tmp_path / "results"
    names = {path.name for path in results.iterdir()}
    assert names == {"README.md", "figure.svg", "measurements.csv", "table.csv"}
    settings = [json.loads((tmp_path / m / "settings.json").read_text()) for m in "123"]
    assert [one["seeds"] for one in settings] == [[2, 3], [4, 5], [6, 7]]
    assert len({one["identity"]["canonical"] for one in settings}) == 3
    with (results / "table.csv").open() as file:
        assert len(list(csv.DictReader(file))) == 3 * 3
    before = (results / "table.csv").read_bytes()
    again = run()
    said = " ".join(again.stderr.split())  # The terminal may break lines anywhere.
    assert said.count("is already complete; nothing to do") == 3
    assert (results / "table.csv").read_bytes() == before

"""The whole study, small."""

from __future__ import annotations

import csv
import json

import pytest

from tests.benchmarks.quick import quick_run


@pytest.mark.slow
def test_a_quick_run_draws_everything_anew_and_goes_on_at_once(tmp_path):
    first = quick_run("reliability", tmp_path)
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
    again = quick_run("reliability", tmp_path)
    said = " ".join(again.stderr.split())  # The terminal may break lines anywhere.
    assert said.count("is already complete; nothing to do") == 3
    assert (results / "table.csv").read_bytes() == before

"""All experiments, small."""

from __future__ import annotations

import shutil

import pytest

from tests.benchmarks.quick import quick_run


@pytest.mark.slow
def test_a_quick_run_writes_everything_and_goes_on_from_what_is_kept(tmp_path):
    first = quick_run("paper", tmp_path)
    assert first.returncode == 0, first.stderr
    results = tmp_path / "results"
    names = {path.name for path in results.iterdir()}
    assert {"README.md", "table.csv", "table.tex", "crossplay.csv", "bodies.csv"} <= names
    assert {"frontiers.svg", "frontiers.pdf", "pairs.svg", "pairs.pdf"} <= names
    before = (results / "table.csv").read_bytes()
    shutil.rmtree(tmp_path / "seed-0")  # As on another machine.
    again = quick_run("paper", tmp_path)
    assert "jobs to go" not in again.stdout
    assert (results / "table.csv").read_bytes() == before

"""The whole study, small."""

from __future__ import annotations

import csv

import pytest

from benchmarks.measures.__main__ import main
from tests.benchmarks.quick import quick_run


@pytest.mark.slow
def test_a_quick_run_goes_from_searches_to_the_account_and_goes_on_at_once(tmp_path):
    first = quick_run("measures", tmp_path)
    assert first.returncode == 0, first.stderr
    results = tmp_path / "results"
    names = {path.name for path in results.iterdir()}
    assert names == {"README.md", "figure.svg", "points.csv", "table.csv"}
    with (results / "points.csv").open() as file:
        points = list(csv.DictReader(file))
    # Five searches of two seeds and two λ.
    assert len(points) == 5 * 2 * 2
    before = {name: (results / name).read_bytes() for name in names}
    again = quick_run("measures", tmp_path)
    assert "0 to do" in again.stdout
    assert {name: (results / name).read_bytes() for name in names} == before


def test_seeds_that_cannot_be_read_are_refused_before_any_work(capsys):
    assert main(["--seeds", "one"]) == 2
    assert "--seeds 'one'" in capsys.readouterr().err

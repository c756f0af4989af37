"""The whole study, small."""

from __future__ import annotations

import csv

import pytest

from benchmarks.physics.__main__ import main
from tests.benchmarks.quick import quick_run


@pytest.mark.slow
def test_a_quick_run_leaves_everything_and_goes_on_at_once(tmp_path):
    first = quick_run("physics", tmp_path)
    assert first.returncode == 0, first.stderr
    results = tmp_path / "results"
    names = {path.name for path in results.iterdir()}
    assert names == {"README.md", "figure.svg", "table.csv"}
    with (results / "table.csv").open() as file:
        steps = {row["step"] for row in csv.DictReader(file)}
    assert steps == {"0.02", "0.01", "0.005", "0.002", "0.001"}
    before = {name: (results / name).read_bytes() for name in names}
    again = quick_run("physics", tmp_path)
    assert "closed" not in again.stdout
    assert {name: (results / name).read_bytes() for name in names} == before


def test_parts_of_another_plan_are_refused_before_any_work(tmp_path, capsys):
    (tmp_path / "plan.json").write_text('{"episodes": 3}')
    assert main(["--quick", "--out", str(tmp_path)]) == 2
    assert "holds parts of another plan: choose another place with --out" in capsys.readouterr().err

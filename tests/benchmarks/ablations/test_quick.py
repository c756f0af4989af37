"""The whole study, small."""

from __future__ import annotations

import csv

import pytest

from benchmarks.ablations.__main__ import main
from tests.benchmarks.quick import quick_run


@pytest.mark.slow
def test_a_quick_run_goes_from_training_to_the_account_and_goes_on_at_once(tmp_path):
    first = quick_run("ablations", tmp_path)
    assert first.returncode == 0, first.stderr
    results = tmp_path / "results"
    names = {path.name for path in results.iterdir()}
    assert names == {"README.md", "figure.svg", "size.csv", "table.csv"}
    with (results / "size.csv").open() as file:
        sizes = list(csv.DictReader(file))
    assert len(sizes) == 2 * 7 * 2  # Judges, humans, sizes.
    before = {name: (results / name).read_bytes() for name in names}
    again = quick_run("ablations", tmp_path)
    assert "0 of 8 parts to do" in again.stdout
    assert {name: (results / name).read_bytes() for name in names} == before
    (tmp_path / "default" / "s0.json").write_text("{")
    damaged = quick_run("ablations", tmp_path)
    assert damaged.returncode == 2
    assert "s0.json is damaged: delete it to make it again" in damaged.stderr


def test_a_directory_of_something_else_is_refused_before_any_work(tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("mine")
    assert main(["--quick", "--out", str(tmp_path)]) == 2
    assert "is not empty and holds no measurement" in capsys.readouterr().err

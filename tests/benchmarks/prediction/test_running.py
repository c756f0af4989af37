"""The command line, and the whole road."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
FILES = {
    "README.md", "table.csv", "humans.csv", "correlations.csv", "differences.csv", "figure.svg",
}  # fmt: skip


def prediction(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "benchmarks.prediction", *map(str, arguments)],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip


def test_help_shows_an_example():
    found = prediction("--help")
    assert found.returncode == 0
    assert "python -m benchmarks.prediction --quick" in found.stdout


@pytest.mark.parametrize("option", ["--out", "--results"])
def test_a_place_that_is_a_file_exits_with_2_and_says_so(tmp_path, option):
    (tmp_path / "file").touch()
    places = {"--out": tmp_path / "out", "--results": tmp_path / "results"}
    places[option] = tmp_path / "file"
    found = prediction("--quick", *(part for place in places.items() for part in place))
    assert found.returncode == 2
    assert found.stderr.startswith("prediction: cannot write to")
    assert f"choose another place with {option}" in found.stderr


@pytest.mark.slow
def test_the_quick_road_writes_everything_and_goes_on_where_it_was(tmp_path):
    first = prediction("--quick", "--out", tmp_path / "runs", "--results", tmp_path / "results")
    assert first.returncode == 0, first.stderr
    assert {path.name for path in (tmp_path / "results").iterdir()} == FILES
    with (tmp_path / "results" / "table.csv").open(encoding="utf-8") as file:
        assert len(list(csv.DictReader(file))) == 4
    texts = {name: (tmp_path / "results" / name).read_bytes() for name in FILES}
    again = prediction("--quick", "--out", tmp_path / "runs", "--results", tmp_path / "results")
    assert again.returncode == 0, again.stderr
    assert "meets" not in again.stdout
    assert texts == {name: (tmp_path / "results" / name).read_bytes() for name in FILES}

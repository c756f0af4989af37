"""`rigid pairs`: a file that can be read again, a table, and refusals."""

from __future__ import annotations

import shutil

import pytest

from rigid.data.pair_file import load_pairs
from tests.compute.shown_reach import count_as_rigids_own, put


@pytest.fixture
def run(single_run, tmp_path, monkeypatch):
    """A toy run with danger pairs."""
    count_as_rigids_own(monkeypatch)
    copy = shutil.copytree(single_run.directory, tmp_path / "run")
    put(copy, s0_r1_l1=(0.5, 0.9, 0.875), s0_r1_l2=(0.55, 0.125, 0.125), s0_r2_l1=(1.0, 0.5, 0.5))
    return copy


def test_pairs_writes_a_file_and_prints_a_line_for_each_pair(rigid, run, tmp_path):
    out = tmp_path / "study" / "pairs.json"
    options = ("--kind", "danger", "--count", 2, "--out", out)
    code, text, err = rigid("pairs", run, *options)
    assert code == 0
    found = load_pairs(out)
    lines = text.splitlines()
    assert lines[0].split()[:5] == ["pair", "episode", "x", "y", "step"]
    assert len(lines) == 4
    for line, pair in zip(lines[1:3], found.pairs, strict=True):
        assert line.startswith(f"   {found.pairs.index(pair) + 1}  s0-r1-l2 {pair.first.shown}")
        assert "0.550  0.125" in line
        assert line.endswith("../run")
    assert lines[3] == f"2 danger pairs of 4 eligible: {out}"
    assert "6 episodes of adversaries" in err
    before = out.read_bytes()
    assert rigid("pairs", run, *options)[0] == 0
    assert out.read_bytes() == before


def test_too_few_pairs_leave_no_file(rigid, run, tmp_path):
    code, text, err = rigid("pairs", run, "--kind", "danger", "--out", tmp_path / "pairs.json")
    assert (code, text) == (2, "")
    assert "2 of 30 danger pairs could be picked" in err
    assert not (tmp_path / "pairs.json").exists()


def test_a_run_has_to_be_named(rigid, tmp_path):
    code, _, err = rigid("pairs", "--kind", "danger", "--out", tmp_path / "pairs.json")
    assert code == 2
    assert "pairs needs at least one run directory" in err


def test_help_says_what_each_kind_is(capsys, monkeypatch):
    from rigid.cli import run as rigid

    monkeypatch.setenv("COLUMNS", "200")
    with pytest.raises(SystemExit):
        rigid(["pairs", "--help"])
    text = " ".join(capsys.readouterr().out.split())
    for words in ("unlike in harm", "similar in harm", "an adversary's episode and a recorded one"):
        assert words in text

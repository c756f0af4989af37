"""What a curve of eight seeds costs."""

from __future__ import annotations

import pytest

from benchmarks.paired import find
from benchmarks.standard.costs import cost_rows, ratio
from benchmarks.standard.pairing import POOLED
from tests.benchmarks.standard.samples import each


def runs(seeds, *, standard, paper):
    """Measurements of so many seeds, of so many core-seconds each."""
    heights = dict.fromkeys(range(seeds), 0.4)
    return {
        "standard": each(heights, core_seconds=standard, env_steps=576),
        "paper": each(heights, core_seconds=paper, env_steps=10368),
    }


def test_a_cost_is_that_of_eight_seeds_however_many_were_measured():
    rows = cost_rows({"a": runs(2, standard=100.0, paper=1500.0)})
    row = find(rows, robot="a", preset="standard")
    assert (row["seeds"], row["core_seconds"], row["env_steps"]) == (2, 800.0, 8 * 576)


def test_seeds_that_only_one_preset_has_do_not_count():
    measured = runs(1, standard=100.0, paper=1500.0)
    measured["standard"] |= each({1: 0.4}, core_seconds=900.0)
    rows = cost_rows({"a": measured})
    assert find(rows, robot="a", preset="standard")["seeds"] == 1
    assert ratio(rows, "a") == 15.0


def test_robots_are_averaged_each_counting_once():
    rows = cost_rows({
        "a": runs(1, standard=100.0, paper=1500.0), "b": runs(3, standard=300.0, paper=2500.0),
    })  # fmt: skip
    assert find(rows, robot=POOLED, preset="standard")["core_seconds"] == 1600.0
    assert ratio(rows, POOLED) == 10.0


@pytest.mark.parametrize("paper", [{}, each({1: 0.4})], ids=["nothing", "another-seed"])
def test_a_robot_without_a_pair_has_no_cost_yet(paper):
    assert cost_rows({"a": {"standard": each({0: 0.4}), "paper": paper}}) == []


def test_where_no_time_was_counted_the_ratio_is_unknown():
    rows = cost_rows({"a": runs(1, standard=0.0, paper=0.0)})
    assert ratio(rows, "a") is None

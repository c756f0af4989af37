"""What a curve of eight seeds costs."""

from __future__ import annotations

from benchmarks.paired import find
from benchmarks.standard.costs import cost_rows, ratio
from benchmarks.standard.pairing import POOLED
from tests.benchmarks.standard.samples import frontier


def runs(seeds, *, standard, paper):
    """Two measurements of so many seeds, of so many core-seconds each."""
    heights = dict.fromkeys(range(seeds), 0.4)
    return {
        "standard": frontier(heights, core_seconds=standard, env_steps=576),
        "paper": frontier(heights, core_seconds=paper, env_steps=10368),
    }


def test_a_cost_is_that_of_eight_seeds_however_many_were_measured():
    rows = cost_rows({"a": runs(2, standard=100.0, paper=1500.0)})
    row = find(rows, robot="a", preset="standard")
    assert (row["seeds"], row["core_seconds"], row["env_steps"]) == (2, 800.0, 8 * 576)


def test_the_ratio_is_that_of_equally_many_seeds():
    measured = runs(2, standard=100.0, paper=1500.0) | {
        "paper": frontier({0: 0.4}, core_seconds=1500.0)
    }
    assert ratio(cost_rows({"a": measured}), "a") == 15.0


def test_robots_are_averaged_each_counting_once():
    rows = cost_rows({
        "a": runs(1, standard=100.0, paper=1500.0), "b": runs(3, standard=300.0, paper=2500.0),
    })  # fmt: skip
    assert find(rows, robot=POOLED, preset="standard")["core_seconds"] == 1600.0
    assert ratio(rows, POOLED) == 10.0


def test_a_robot_with_one_preset_alone_has_no_cost_yet():
    assert cost_rows({"a": {"standard": frontier({0: 0.4})}}) == []


def test_where_no_time_was_counted_the_ratio_is_unknown():
    rows = cost_rows({"a": runs(1, standard=0.0, paper=0.0)})
    assert ratio(rows, "a") is None

"""Tables and text from points set by hand."""

from __future__ import annotations

import pytest

from benchmarks.measures.account import account
from benchmarks.measures.drawing import draw
from benchmarks.measures.plan import PLAN as FULL
from benchmarks.measures.summary import (
    cost_rows,
    headline_rows,
    point_rows,
    share_rows,
    union_rows,
)
from benchmarks.paired import find
from rigid.naturalness.choice import MEASURES
from tests.benchmarks.measures.samples import PLAN, searched, study


def all_rows(found):
    return [
        *headline_rows(found),
        *union_rows(found),
        *share_rows(found, PLAN.measures),
        *cost_rows(found),
    ]


def test_every_measure_is_searched_with_and_two_of_them_twice():
    searches = FULL.searches()
    assert {one.measure for one in searches} == set(MEASURES)
    assert [one.name for one in searches if one.shift] == ["lsgan-again", "ensemble-again"]
    assert not {seed for one in searches if one.shift for seed in one.seeds((0, 1))} & {0, 1}


def test_points_of_a_second_search_stand_under_the_seeds_of_the_study():
    again = searched("lsgan-again", {0: [(0.5, 0.5)], 3: [(0.1, 0.9)]}, shift=1000)
    assert [point["seed"] for point in again.points] == [0, 3]
    assert list(again.by_seed()) == [0, 3]


def test_measures_are_compared_with_the_reference_and_the_ensemble_with_its_members():
    pairs = {(row["name"], row["reference"]) for row in headline_rows(study())}
    assert pairs == {
        ("lsgan", ""),
        ("mmd", "lsgan"),
        ("ensemble", "lsgan"),
        ("ensemble", "mmd"),
        ("lsgan-again", "lsgan"),
        ("ensemble-again", "lsgan"),
    }


def test_a_headline_difference_is_the_mean_over_seeds():
    row = find(headline_rows(study()), name="mmd", number="worst_at_0.9")
    assert row["value"] == pytest.approx(0.6)
    assert row["difference"] == pytest.approx(0.6)  # The reference's is canonical play's, 0.


def test_unions_have_equal_numbers_of_searches():
    rows = union_rows(study())
    assert {row["searches"] for row in rows} == {2}
    row = find(rows, name="ensemble, twice", reference="lsgan + mmd", number="worst_at_0.9")
    assert row["difference"] == pytest.approx(-0.6)


def test_what_a_measure_finds_alone_is_counted_without_second_searches():
    rows = share_rows(study(), PLAN.measures)
    counts = {
        name: find(rows, name=name, number="clearly_alone")["value"] for name in PLAN.measures
    }
    assert counts == {"lsgan": 0, "mmd": 2, "ensemble": 0}  # One point in each of two seeds.
    area = find(rows, name="mmd", number="exclusive_area")
    # Hull over (0, 1), (.9, .6), (1, 0): .72 + .03; without: (0, 1), (1, 0) with (.5, .5): .5.
    assert area["value"] == pytest.approx(0.25)


def test_a_point_below_canonical_play_is_no_find():
    found = study() | {"mmd": searched("mmd", {0: [(0.95, 0.01)], 1: [(0.95, 0.01)]}, anchor=0.1)}
    row = find(share_rows(found, PLAN.measures), name="mmd", number="alone")
    assert row["value"] == 0


def test_a_point_that_faulted_is_listed_and_marked_as_nothing():
    found = study()
    found["mmd"].frontier.data["points"][1]["faults"] = 1  # One of ten episodes.
    rows = [row for row in point_rows(found, PLAN.measures) if row["name"] == "mmd"]
    assert [row["clearly_alone"] for row in rows] == [0, 0, 0, 1]
    assert rows[1]["naturalness"] == 0.9


def test_text_and_table_agree(tmp_path):
    found = study()
    rows = all_rows(found)
    text = account(PLAN, found, rows)
    assert "| `mmd` | 0.600 [0.600, 0.600] |" in text
    assert "It finds more than `lsgan` by `worst_at_0.9` (+0.600 [+0.600, +0.600])" in text
    assert "were found by `mmd`." in text
    assert "below it in 3 of 3 numbers" in text
    assert "{" not in text
    draw(tmp_path / "figure.svg", found, rows, PLAN.measures)
    assert (tmp_path / "figure.svg").stat().st_size > 10_000

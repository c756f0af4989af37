"""Rows that compare numbers by search seed."""

from __future__ import annotations

import pytest

from benchmarks.paired import compared, difference_text, find, markdown, plain, sign, value_text


def row_of(mine, theirs):
    return compared({"name": "a"}, "auc", mine, reference="b", theirs=theirs)


def test_differences_are_paired_by_seed_and_have_a_t_interval():
    row = row_of({0: 0.5, 1: 0.7, 2: 0.9}, {0: 0.4, 1: 0.5, 2: 0.6})
    # Differences .1, .2, .3: mean .2, s = .1, t(2) = 4.3027, so ± .2484.
    assert row["difference"] == pytest.approx(0.2)
    assert row["difference_low"] == pytest.approx(0.2 - 0.2484, abs=1e-4)
    assert row["difference_high"] == pytest.approx(0.2 + 0.2484, abs=1e-4)
    assert (row["value"], row["seeds"], row["reference"]) == (pytest.approx(0.7), 3, "b")


def test_only_common_seeds_count_in_a_difference():
    row = row_of({0: 0.1, 5: 0.9}, {5: 0.8})
    assert row["difference"] == pytest.approx(0.1)
    assert row["difference_low"] is None


def test_nothing_is_known_of_a_variant_without_a_seed():
    row = row_of({}, {0: 0.5})
    assert row["value"] is None
    assert row["difference"] is None
    assert value_text(row) == "unknown"


@pytest.mark.parametrize(
    ("mine", "side"),
    [
        ({0: 0.5, 1: 0.51, 2: 0.52}, 1),
        ({0: 0.1, 1: 0.11, 2: 0.12}, -1),
        ({0: 0.1, 1: 0.3, 2: 0.5}, 0),
    ],
)
def test_a_side_is_taken_only_with_the_whole_interval(mine, side):
    assert sign(row_of(mine, dict.fromkeys(mine, 0.3))) == side


def test_a_single_seed_takes_no_side():
    assert sign(row_of({0: 1.0}, {0: 0.0})) == 0


def test_a_difference_that_rounds_to_nothing_has_no_minus_sign():
    row = row_of({0: 0.30001, 1: 0.30001}, {0: 0.30002, 1: 0.30002})
    assert difference_text(row) == "+0.000 [+0.000, +0.000]"


def test_a_row_that_is_not_unique_is_refused():
    rows = [plain({"name": "a"}, "points", 3), plain({"name": "a"}, "points", 4)]
    with pytest.raises(ValueError, match="2 rows have"):
        find(rows, name="a", number="points")
    with pytest.raises(ValueError, match="0 rows have"):
        find(rows, name="b")


def test_a_table_has_a_line_under_its_heads():
    assert markdown(("a", "b"), [["1", "2"]]).splitlines() == [
        "| a | b |",
        "| --- | --- |",
        "| 1 | 2 |",
    ]

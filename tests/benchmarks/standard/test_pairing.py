"""Values of both presets are paired by robot and search seed."""

from __future__ import annotations

import pytest

from benchmarks.paired import find
from benchmarks.standard.pairing import POOLED, pairs_of, seed_rows, values
from rigid.frontier.intervals import t_interval
from tests.benchmarks.standard.samples import both, each, frontier, rows_of


def pairs(number, standard, paper, **options):
    (found,) = [
        one for one in pairs_of("a", both(standard, paper, **options)) if one.number == number
    ]
    return found


def test_values_are_paired_by_seed_and_not_by_order():
    found = pairs("auc", {0: 0.2, 1: 0.4, 2: 0.8}, {2: 0.7, 1: 0.4, 0: 0.4})
    # `auc` is .45 + h / 2.
    assert found.differences == pytest.approx([-0.1, 0.0, 0.05])


def test_the_difference_is_standard_minus_paper_with_a_t_interval():
    rows = rows_of({"a": both({0: 0.3, 1: 0.5, 2: 0.7}, {0: 0.4, 1: 0.7, 2: 1.0})})
    row = find(rows, robot="a", number="auc")
    differences = [-0.05, -0.1, -0.15]
    ends = row["difference_low"], row["difference_high"]
    assert row["difference"] == pytest.approx(-0.1)
    assert ends == pytest.approx(t_interval(differences, bounds=(-1.0, 1.0)))


def test_a_robot_of_unequal_seeds_uses_only_the_common_ones_in_means_as_well():
    row = find(rows_of({"a": both({0: 0.2, 3: 0.4}, {3: 0.6, 4: 0.9})}), robot="a", number="auc")
    assert row["seeds"] == 1
    assert (row["standard"], row["paper"]) == (pytest.approx(0.65), pytest.approx(0.75))
    assert row["difference"] == pytest.approx(-0.1)


def test_fewer_than_two_pairs_have_no_interval():
    row = find(rows_of({"a": both({0: 0.2}, {0: 0.4})}), robot="a", number="auc")
    assert (row["difference_low"], row["difference_high"]) == (None, None)


def test_a_robot_without_one_of_the_presets_has_no_pairs():
    rows = rows_of({"a": {"standard": each({0: 0.2})}})
    row = find(rows, robot="a", number="auc")
    assert (row["seeds"], row["standard"], row["difference"]) == (0, None, None)


def test_robots_are_pooled_seed_by_seed_where_all_of_them_have_the_seed():
    rows = rows_of({
        "a": both({0: 0.2, 1: 0.4, 2: 0.9}, {0: 0.4, 1: 0.4, 2: 0.1}),
        "b": both({1: 0.8, 0: 0.6}, {0: 0.8, 1: 0.4}),
    })  # fmt: skip
    row = find(rows, robot=POOLED, number="auc")
    # Seed 0: both -.1; seed 1: 0 and .2. Two differences, not five.
    differences = [-0.1, 0.1]
    assert (row["seeds"], row["difference"]) == (2, pytest.approx(0.0))
    ends = row["difference_low"], row["difference_high"]
    assert ends == pytest.approx(t_interval(differences, bounds=(-1.0, 1.0)))


@pytest.mark.parametrize(("number", "value"), [("worst_at_0.8", 0.4), ("worst_at_0.9", 0.0)])
def test_each_worst_at_has_its_own_level(number, value):
    assert pairs(number, {0: 0.4}, {0: 0.4}, natural=0.85).standard == {0: value}


def test_hull_at_mixes_two_humans():
    # A third of the way from (.85, .3) to canonical play at (1, 0).
    found = pairs("hull_at_0.9", {0: 0.3}, {0: 0.3}, natural=0.85)
    assert found.standard[0] == pytest.approx(0.2)


def test_a_seed_alone_has_the_numbers_that_it_has_among_others():
    heights = {0: 0.2, 1: 0.4, 4: 0.9}
    together = frontier(heights)
    assert values(each(heights)) == values(dict.fromkeys(heights, together))


def test_every_pair_is_listed_with_both_values():
    found = pairs_of("a", both({0: 0.2, 1: 0.4}, {1: 0.6}))
    (row,) = [row for row in seed_rows(found) if row["number"] == "auc"]
    assert (row["seed"], row["standard"], row["paper"]) == (
        1, pytest.approx(0.65), pytest.approx(0.75),
    )  # fmt: skip

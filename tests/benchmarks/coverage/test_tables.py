"""From results by seed to the rows of the table and the text."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.coverage.account import (
    better_difference,
    gate_verdict,
    jumps,
    listed,
    verdict,
    why,
    write_account,
)
from benchmarks.coverage.account_tables import gate_table
from benchmarks.coverage.laws import beta
from benchmarks.coverage.plan import PLAN
from benchmarks.coverage.tables import CHECK, GATE, PRINTED, law_rows, search_rows, series_of
from benchmarks.paired import find

SMALL = replace(
    PLAN, sizes=(3, 5), draws=4000, bca_draws=5, redraws=5, redraw_draws=100,
    preset=replace(PLAN.preset, seeds=tuple(range(40))),
)  # fmt: skip


@pytest.fixture(scope="module")
def population():
    """Normal numbers for the first robot, and the same moved by 0.1 for the second."""
    values = np.random.default_rng(2).normal(0.4, 0.05, size=40)
    rows = [
        {"tolerance": tolerance, "seed": seed, "worst_lambda": 0.3}
        | {"worst_at": y, "auc_natural": y / 2, "auc": y, "hull_at": y}
        for tolerance, moved in zip(SMALL.tolerances, (0.0, 0.1), strict=True)
        for seed, y in enumerate(values + moved)
    ]
    return rows[::-1]  # Seeds in any order.


@pytest.fixture(scope="module")
def series(population):
    return series_of(population, SMALL.tolerances)


@pytest.fixture(scope="module")
def rows(series):
    return [*search_rows(series, SMALL), *law_rows(SMALL, [beta(8, 8), beta(0.2, 9.8)])]


def row(quantity="auc, tolerance 1", n=3, interval=PRINTED, **changes):
    facts = {
        "source": "searches",
        "cover": 0.95,
        "truth_above": 0.025,
        "truth_below": 0.025,
        "leaves_92_98": False,
    }
    return {"quantity": quantity, "n": n, "interval": interval, **facts, **changes}


def test_differences_are_the_first_robot_minus_the_second_on_the_same_seed(series):
    by_name = {one.quantity: one for one in series}
    assert by_name["auc, difference"].values == pytest.approx([-0.1] * 40)
    assert by_name["auc, difference"].bounds == (-1.0, 1.0)
    assert len(series) == 3 * 4


def test_numbers_that_do_not_differ_have_no_skewness_and_are_covered(rows):
    found = find(rows, quantity="auc, difference", n=3, interval=PRINTED)
    assert (found["skewness"], found["cover"]) == (None, 1.0)


def test_the_truth_of_searches_is_the_mean_of_all_seeds(rows, series):
    found = find(rows, quantity="worst_at, tolerance 1", n=3, interval=PRINTED)
    assert found["truth"] == pytest.approx(series[0].values.mean())


def test_every_number_is_tried_with_every_interval_at_every_size(rows):
    at_three = {(r["quantity"], r["interval"]) for r in rows if r["n"] == 3}
    # Searches have the check as well, and differences the unpaired one.
    assert len(at_three) == 12 * 4 + 4 + 2 * 3
    assert {r["n"] for r in rows if r["interval"] == "BCa"} == {30}


def test_with_and_without_replacement_agree_on_a_normal_population(rows):
    covers = [
        find(rows, quantity="auc, tolerance 1", n=5, interval=name)["cover"]
        for name in (PRINTED, CHECK)
    ]
    assert covers == pytest.approx([0.95, 0.95], abs=0.03)


def test_a_cover_outside_92_to_98_percent_is_marked(rows):
    assert not find(rows, quantity="Beta(8, 8)", n=3, interval=PRINTED)["leaves_92_98"]
    assert find(rows, quantity="Beta(0.2, 9.8)", n=3, interval=PRINTED)["leaves_92_98"]


def test_the_verdict_names_every_case_outside():
    cases = [row(), row(n=5, cover=0.9, leaves_92_98=True), row(n=8, cover=0.99, leaves_92_98=True)]
    expected = (
        "covers of 0.900 to 0.990; 2 of 3 cases leave 92 to 98 %: auc, tolerance 1 (n = 5, 8)."
    )
    assert verdict(cases) == expected
    assert verdict([row()]) == "covers of 0.950 to 0.950; all 1 cases lie within 92 to 98 %."


def test_the_upper_end_is_blamed_only_where_the_truth_lies_above():
    short = row(cover=0.9, truth_above=0.09, truth_below=0.01)
    assert "*upper* end" in why([short])
    assert "*upper* end" not in why([row(cover=0.9, truth_above=0.01, truth_below=0.09)])
    assert why([row()]) == "No case covers less than 92 %."


def test_seeds_are_told_apart_by_whether_both_robots_have_their_worst_at_the_same_lambda():
    def rows_of(tolerance, values, lambdas):
        return [
            {"tolerance": tolerance, "seed": seed, "worst_at": y, "worst_lambda": lambda_}
            for seed, (y, lambda_) in enumerate(zip(values, lambdas, strict=True))
        ]

    first = rows_of(1.0, [0.5, 0.6, 0.9, 0.8], [0.3, 0.3, 1.0, 1.0])
    second = rows_of(1.5, [0.4, 0.3, 0.1, 0.1], [0.3, 0.3, 0.3, None])
    expected = (
        "On 2 seeds (difference 0.200, deviation 0.141) it comes from the same λ with both "
        "robots; on 2 seeds (difference 0.750, deviation 0.071) from another."
    )
    assert jumps([*first, *second], (1.0, 1.5)) == expected


@pytest.mark.parametrize(("width", "better"), [(0.04, True), (0.2, False)])
def test_the_hull_is_called_better_only_where_it_is_in_cover_and_width(width, better):
    cases = [
        row("worst_at, difference", n=8, cover=0.8, width=0.1),
        row("hull_at, difference", n=8, cover=0.95, width=width),
    ]
    said = better_difference(cases, [8])
    assert said.startswith("Worst cover as printed: 0.800 for `worst_at`, 0.950 for `hull_at`;")
    assert ("better number" in said) == better


def gated_cases(quantity, t, gate, **changes):
    """The same number with both upper bounds."""
    return [
        row(quantity, interval=interval, truth_above=above, **changes)
        for interval, above in ((PRINTED, t), (GATE, gate))
    ]


def test_the_gates_table_shows_both_bounds_and_marks_what_is_exceeded_too_often():
    cases = [
        *gated_cases("auc, tolerance 1", 0.02, 0.01),
        *gated_cases("rare", 0.3, 0.051, source="law"),
    ]
    lines = gate_table(cases, [3]).splitlines()
    assert lines[0] == "|  | n = 3: t | gate |"
    assert lines[2:] == [
        "| `auc, tolerance 1` | 0.020 | 0.010 |",
        "| `rare` | **0.300** | **0.051** |",
    ]


def test_the_gates_table_leaves_out_what_the_gate_takes_no_such_bound_of():
    others = ("auc_natural, tolerance 1", "hull_at, tolerance 1", "worst_at, difference")
    cases = [case for name in others for case in gated_cases(name, 0.3, 0.3)]
    assert len(gate_table(cases, [3]).splitlines()) == 2


def test_the_gates_verdict_counts_where_the_truth_lies_above_too_often():
    cases = [
        *gated_cases("worst_at, tolerance 1", 0.08, 0.04),
        *gated_cases("rare", 0.3, 0.2, source="law"),
    ]
    expected = (
        "Truth above the bound in more than 5 %: *t* 2 of 2 cases (worst 0.300), "
        "*gate* 1 of 2 cases (worst 0.200)."
    )
    assert gate_verdict(cases, [3]) == expected


def test_the_gate_promises_less_than_t_of_a_skewed_law(rows):
    found = [
        find(rows, quantity="Beta(0.2, 9.8)", n=5, interval=interval)["truth_above"]
        for interval in (PRINTED, GATE)
    ]
    assert found[0] > 1.5 * found[1]


def test_the_account_holds_the_covers_of_the_table(rows, population, tmp_path):
    write_account(tmp_path / "README.md", SMALL, population, rows)
    text = (tmp_path / "README.md").read_text(encoding="utf-8")
    covers = [find(rows, quantity="Beta(8, 8)", n=n, interval=PRINTED)["cover"] for n in (3, 5)]
    assert f"| `Beta(8, 8)` | 0.0 | {covers[0]:.3f} | {covers[1]:.3f} |" in text
    above = [
        find(rows, quantity="Beta(8, 8)", n=n, interval=interval)["truth_above"]
        for n in (3, 5)
        for interval in (PRINTED, GATE)
    ]
    assert f"| `Beta(8, 8)` | {' | '.join(f'{share:.3f}' for share in above)} |" in text
    assert "{" not in text


def test_one_word_is_listed_alone():
    assert listed(["3"]) == "3"

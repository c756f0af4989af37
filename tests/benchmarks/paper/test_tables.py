"""The comparison of recipes, from frontiers whose numbers are known."""

from __future__ import annotations

import json

import pytest

from benchmarks.kept import kept_run
from benchmarks.paper.account import _percent, account, caution, verdicts
from benchmarks.paper.failing import failure_rows
from benchmarks.paper.measuring import Measuring
from benchmarks.paper.places import Places
from benchmarks.paper.tables import (
    TITLES,
    body_rows,
    difference_rows,
    floor_rows,
    level_rows,
    measured_bodies,
    measured_recipes,
    method_rows,
    natural_failure_rows,
    unseen_rows,
)
from rigid.report.tables import latex
from rigid.tasks.registry import make_task
from tests.benchmarks.paper.samples import PLAN, keep, played

COLUMNS = (
    "method,worst_at_0.9,worst_at_0.9_low,worst_at_0.9_high,worst_at_0.9_vs_vanilla_high,"
    "auc_natural,auc_natural_low,auc_natural_high,auc_natural_vs_vanilla_high,"
    "auc,auc_low,auc_high,auc_paper_axis,success,success_low,success_high,robot_seeds,search_seeds"
)
CROSSPLAY = [
    played("vanilla", 0, 0, 1.0), played("vanilla", 1, 1, 0.9), played("vanilla", 0, 1, 0.2),
    played("vanilla", 1, 0, 0.4), played("vanilla", 0, -1, 0.1, human="passive"),
    played("robust-gt", 0, 0, 1.0),
]  # fmt: skip


@pytest.fixture
def places(tmp_path):
    """Two vanilla robots, one robust; every adversary of the latter does 0.2 less harm."""
    places = Places(tmp_path / "raw", tmp_path / "results")
    keep(places, "vanilla", 0, {0: 0.5, 1: 0.6, 2: 0.55})
    keep(places, "vanilla", 1, {0: 0.4, 1: 0.5, 2: 0.45})
    keep(places, "robust-gt", 0, {0: 0.3, 1: 0.4, 2: 0.35})
    return places


@pytest.fixture
def measuring(places):
    return Measuring(PLAN, places, make_task("itch-scratching"))


def test_the_table_has_the_columns_of_the_contract_and_a_row_for_each_method(measuring):
    rows = method_rows(measured_recipes(PLAN, measuring), CROSSPLAY)
    assert ",".join(rows[0]) == COLUMNS
    assert [row["method"] for row in rows] == ["vanilla", "robust-gt"]
    assert [(row["robot_seeds"], row["search_seeds"]) for row in rows] == [(2, 3), (1, 3)]


def test_numbers_are_means_over_robots_and_search_seeds(measuring):
    vanilla, robust = method_rows(measured_recipes(PLAN, measuring), CROSSPLAY)
    assert vanilla["worst_at_0.9"] == pytest.approx(0.5)
    assert vanilla["auc"] == pytest.approx(0.45 + 0.25)
    assert robust["worst_at_0.9"] == pytest.approx(0.35)


def test_differences_pair_robots_and_search_seeds(measuring):
    """The one robot that both have: every adversary does 0.2 less harm, so nothing varies."""
    measured = measured_recipes(PLAN, measuring)
    _, robust = method_rows(measured, CROSSPLAY)
    assert robust["worst_at_0.9_vs_vanilla_high"] == pytest.approx(-0.2)
    found = {row["number"]: row["difference"] for row in difference_rows(measured)}
    assert found["worst_at"] == pytest.approx(-0.2)
    assert found["auc"] == pytest.approx(-0.1)


def test_success_is_with_the_own_human_and_unseen_success_with_those_of_other_seeds(measuring):
    measured = measured_recipes(PLAN, measuring)
    vanilla, robust = method_rows(measured, CROSSPLAY)
    assert vanilla["success"] == pytest.approx(0.95)
    assert robust["success"] == 1.0
    assert robust["success_low"] == pytest.approx(0.963, abs=1e-3)  # Wilson, 100 of 100.
    unseen = {row["method"]: row["success"] for row in unseen_rows(measured, CROSSPLAY)}
    assert unseen["vanilla"] == pytest.approx(0.3)
    assert unseen["robust-gt"] is None


def test_success_is_that_of_the_robots_in_the_table(measuring):
    (first,) = method_rows({"vanilla": {0: measuring.frontier("vanilla", 0)}}, CROSSPLAY)
    both = measured_recipes(PLAN, measuring)
    assert first["success"] == 1.0
    assert method_rows(both, CROSSPLAY)[0]["success"] == pytest.approx(0.95)


def test_other_people_are_held_beside_the_reference_person(places, measuring):
    keep(places, "body-tremor", 0, {0: 0.8, 1: 0.8, 2: 0.8})
    rows = body_rows(measured_bodies(PLAN, measuring))
    assert [row["person"] for row in rows] == ["reference person", "tremor"]
    assert rows[1]["worst_at_0.9"] == pytest.approx(0.8)


def test_latex_has_a_line_for_each_method(measuring):
    text = latex(method_rows(measured_recipes(PLAN, measuring), CROSSPLAY), TITLES)
    assert text.splitlines()[4].startswith("Vanilla RL & 0.500 [")
    assert text.splitlines()[5].startswith("Robust GT & 0.350 [")


def test_a_verdict_is_nothing_but_its_interval(measuring):
    measured = measured_recipes(PLAN, measuring)
    said = verdicts(method_rows(measured, CROSSPLAY), difference_rows(measured))
    assert said[0] == (
        "Robust GT minus Vanilla RL, `worst_at`: -0.200 [-0.200, -0.200]: **lower**."
    )


def test_the_account_counts_how_many_differences_exclude_zero():
    rows = [
        {"difference_low": low, "difference_high": high}
        for low, high in ((None, None), (-0.2, -0.1), (-0.1, 0.1), (0.1, 0.2), (0.0, 0.1))
    ]
    assert caution(rows).startswith("Of 4 differences with a 95 % interval, 2 exclude zero;")


def test_a_rare_failure_is_not_said_to_be_none():
    assert [_percent(share) for share in (0.0, 0.004, 0.01, 0.5)] == ["0%", "< 1%", "1%", "50%"]


def test_the_account_says_what_is_missing(places, measuring):
    measured = measured_recipes(PLAN, measuring)
    tables = {
        "table": method_rows(measured, CROSSPLAY), "differences": difference_rows(measured),
        "unseen": unseen_rows(measured, CROSSPLAY), "crossplay": CROSSPLAY[:1], "thorough": [],
        "bodies": [], "failures": [], "natural": [],
        "levels": [], "floors": [],
    }  # fmt: skip
    text = account(PLAN, places, tables)
    assert "So far Gleave et al. 0 of 2, PALM 0 of 2, Robust GT 1 of 2 robots" in text
    assert text.count("Not measured yet; the same command goes on") == 6


def test_failures_have_a_row_for_each_kind_of_each_robot(places):
    modes = [{"title": "Lost the itch", "points": ["a", "b"], "naturalness": [0.4, 0.6],
              "share": 0.1}]  # fmt: skip
    for name, found in (("failures-vanilla-0", {"humans": 6, "modes": modes}),
                        ("failures-vanilla-1", None)):  # fmt: skip
        path = places.kept_part(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(found))
    (row,) = failure_rows(places, ["vanilla", "palm"], (0, 1))
    assert (row["failure"], row["humans"], row["of"]) == ("Lost the itch", 2, 6)
    assert (row["naturalness_low"], row["naturalness_high"], row["share"]) == (0.4, 0.6, 0.1)


def test_natural_failures_are_humans_of_the_papers_range_who_are_not_helped(places, measuring):
    """Every sample has success 0.5; its natural attack lies at 0.9, until it is moved to 0.5."""
    (vanilla, _) = natural_failure_rows(measured_recipes(PLAN, measuring))
    assert (vanilla["humans"], vanilla["failures"], vanilla["point"]) == (0, 0, None)
    keep(places, "gleave", 0, {0: 0.5, 1: 0.6}, natural=0.5)
    gleave = natural_failure_rows(measured_recipes(PLAN, measuring))[1]
    assert (gleave["method"], gleave["humans"], gleave["failures"]) == ("gleave", 2, 2)
    assert (gleave["worst_success"], gleave["worst_naturalness"]) == (0.5, 0.5)


def test_the_worst_from_each_level_on_is_compared(measuring):
    """The attacks lie at 0.9; from 0.5 on their heights differ by 0.2."""
    rows = level_rows(measured_recipes(PLAN, measuring))
    (robust,) = [r for r in rows if (r["method"], r["naturalness"]) == ("robust-gt", 0.5)]
    assert robust["difference"] == pytest.approx(-0.2)
    assert {row["naturalness"] for row in rows} == {0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}


def test_the_floor_of_the_natural_area_is_the_line_from_sabotage_to_canonical_play(places):
    """Sabotage stands at (0, 1), canonical play at (1, 0): the line is 0.1 high on average."""
    keep(places, "palm", 0, {0: 0.05, 1: 0.05})
    measured = {"palm": {0: kept_run(places.kept_run("palm", 0))}}
    (row,) = floor_rows(measured)
    assert row["floor"] == pytest.approx(0.1)
    assert row["auc_natural"] == pytest.approx(0.1)

"""Simulated studies: they have the truth that was asked for, and are judged as real ones are."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.commands.study.power_tables import grid, smallest_lines
from rigid.study.bounds import chance, players_needed, smallest_for, upper_bound
from rigid.study.power import ChoiceDesign, Power, ScaleDesign, Size, power, smallest

SMALL = Size(raters=6, pairs=8)


@pytest.mark.parametrize("preference", [0.5, 0.7])
def test_simulated_choices_have_the_preference_asked_for_whatever_raters_and_pairs_are(preference):
    design = ChoiceDesign(preference=preference, sd_raters=0.8, sd_pairs=1.0)
    asked = design.ask(Size(raters=400, pairs=400), np.random.default_rng(0))
    assert asked.values.mean() == pytest.approx(preference, abs=0.03)


def test_answers_of_one_pair_are_as_alike_as_the_design_says():
    design = ChoiceDesign(sd_raters=0.0, sd_pairs=1.0)
    asked = design.ask(Size(raters=200, pairs=300), np.random.default_rng(0))
    by_pair = asked.values.reshape(200, 300)
    assert by_pair.mean(axis=0).std() > 5 * by_pair.mean(axis=1).std()


@pytest.mark.parametrize("scales", [1, 2])
def test_simulated_scores_differ_by_the_points_asked_for(scales):
    design = ScaleDesign(scales=scales, difference=1.0)
    asked = design.ask(Size(raters=300, pairs=300), np.random.default_rng(0))
    assert asked.values.mean() == pytest.approx(1.0, abs=0.15)  # Ends of the scale take some.
    assert set(asked.values) <= set(range(-7 * scales, 7 * scales + 1))


def test_every_rater_judges_every_pair_once():
    asked = ChoiceDesign().ask(SMALL, np.random.default_rng(0))
    assert len(set(zip(asked.raters.tolist(), asked.pairs.tolist(), strict=True))) == 48


def test_the_power_of_a_size_does_not_depend_on_what_else_is_simulated():
    design = ChoiceDesign()
    alone = power(design, SMALL, simulations=20, seed=3)
    power(design, Size(5, 5), simulations=3, seed=3)
    assert power(design, SMALL, simulations=20, seed=3) == alone


def test_a_large_study_of_no_preference_finds_equivalence():
    design = ChoiceDesign(sd_raters=0.0, sd_pairs=0.0)
    assert power(design, Size(25, 30), simulations=10, seed=0).share == 1.0


def test_at_the_margin_equivalence_is_found_no_more_often_than_the_test_allows():
    found = power(ChoiceDesign(preference=0.6), Size(10, 20), simulations=150, seed=0)
    assert found.share <= 0.05 + 3 * found.error


def test_without_a_difference_one_is_found_no_more_often_than_the_test_allows():
    found = power(ScaleDesign(difference=0.0), Size(6, 15), simulations=150, seed=0)
    assert found.share <= 0.025 + 3 * found.error


def test_more_raters_and_pairs_have_more_power():
    small, large = (
        power(ScaleDesign(), size, simulations=60, seed=0) for size in (Size(3, 5), Size(12, 20))
    )
    assert small.share < large.share - 0.3


def test_a_power_of_all_still_has_an_error():
    design = ChoiceDesign(sd_raters=0.0, sd_pairs=0.0)
    assert power(design, Size(20, 20), simulations=10, seed=0).error > 0.0


def powers(shares):
    return [Power(Size(*size), share, 0.02) for size, share in shares.items()]


def test_the_smallest_sizes_are_those_of_which_no_smaller_one_reaches_the_power():
    found = smallest(
        powers({(10, 20): 0.7, (10, 30): 0.85, (20, 20): 0.9, (20, 30): 0.95, (30, 10): 0.8}), 0.8
    )
    assert [tuple(one.size) for one in found] == [(10, 30), (20, 20), (30, 10)]


def test_a_power_that_no_size_reaches_is_said_so():
    lines = smallest_lines({0.9: smallest(powers({(10, 20): 0.7}), 0.9)})
    assert lines == ["for 0.9: none of these sizes: try more raters and more pairs"]


def test_the_grid_has_raters_as_rows_and_pairs_as_columns():
    assert grid(powers({(5, 10): 0.1, (5, 20): 0.2, (15, 10): 0.3, (15, 20): 0.4})) == [
        "   power     10 pairs     20 pairs",
        " 5 raters 0.10 ± 0.02  0.20 ± 0.02",
        "15 raters 0.30 ± 0.02  0.40 ± 0.02",
    ]


@pytest.mark.parametrize(
    ("above", "players"),
    [pytest.param(0, 59, id="1-0.05**(1/59)<0.05"), pytest.param(1, 93, id="by-table")],
)
def test_players_needed_for_five_percent(above, players):
    assert players_needed(above, 0.05) == players


def test_the_players_needed_are_the_fewest():
    assert (
        upper_bound(2, players_needed(2, 0.1)) <= 0.1 < upper_bound(2, players_needed(2, 0.1) - 1)
    )


def test_the_bound_of_none_above_is_known_in_closed_form():
    assert upper_bound(0, 8) == pytest.approx(1 - 0.05 ** (1 / 8))


def test_too_few_players_can_show_nothing():
    found = chance(8, at_most=0.1, above=0.0)
    assert (found.allowed, found.chance) == (None, 0.0)


def test_the_chance_is_that_of_drawing_no_more_than_may_be_above():
    found = chance(46, at_most=0.1, above=0.01)
    assert found.allowed == 1
    assert found.chance == pytest.approx(0.99**46 + 46 * 0.01 * 0.99**45)


def test_the_smallest_number_of_players_has_the_power():
    assert smallest_for(0.8, at_most=0.1, above=0.01).players == 46


def test_a_share_that_is_as_large_as_the_claim_is_never_shown():
    assert smallest_for(0.8, at_most=0.1, above=0.1) is None

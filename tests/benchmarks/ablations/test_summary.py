"""Tables and text from adversaries set by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from benchmarks.ablations.account import account
from benchmarks.ablations.drawing import draw
from benchmarks.ablations.plan import QUICK
from benchmarks.ablations.summary import numbers_of, size_rows, variant_rows
from benchmarks.paired import find
from tests.benchmarks.ablations.samples import adversaries, point, readings

PLAN = replace(QUICK, lambdas=(0.1, 1.0))


def found_by_all(shift):
    return {
        variant.name: adversaries(0.0 if variant.name == "default" else shift)
        for variant in PLAN.variants()
    }


def test_numbers_are_means_over_lambda_by_seed():
    found = numbers_of(adversaries(), anchor=0.0)
    assert found["naturalness"] == {0: 0.25, 1: 0.25}
    assert found["adversarialness"][0] == pytest.approx(0.65)
    assert found["naturalness@0.1"] == {0: 0.0, 1: 0.0}


def test_the_area_is_that_of_each_seeds_hull():
    # (0, .8), (.5, .5), (1, 0): .325 + .125.
    assert numbers_of(adversaries(), anchor=0.0)["auc"][0] == pytest.approx(0.45)


def test_an_adversary_that_faulted_counts_nowhere():
    points = [*adversaries(), point(0, 2.0, 1.0, 1.0, faults=2)]
    numbers = numbers_of(points, anchor=0.0)
    assert numbers["naturalness"][0] == 0.25
    assert numbers["auc"][0] == pytest.approx(0.45)
    assert numbers["naturalness@2"] == {}


def test_an_adversary_of_whom_nothing_is_known_counts_nowhere():
    points = [*adversaries(), point(0, 2.0, 0.0, None, faults=100)]
    assert numbers_of(points, anchor=0.0)["adversarialness"][0] == pytest.approx(0.65)


def test_variants_are_compared_with_the_default_and_it_with_nothing():
    rows = variant_rows(found_by_all(0.2), PLAN.variants(), anchor=0.0)
    default = find(rows, name="default", number="auc")
    assert (default["reference"], default["difference"]) == ("", None)
    row = find(rows, name="no-noise", number="adversarialness")
    assert row["difference"] == pytest.approx(0.1)  # .2 at one of two λ.
    assert (row["factor"], row["reference"]) == ("noise", "default")


def test_readings_are_averaged_over_canonical_sets():
    several = readings()
    several[0]["naturalness"] = 0.4  # 0.2 in the other set.
    row = size_rows(several)[0]
    assert (row["judge"], row["human"], row["episodes"]) == ("discriminator", "passive", 5)
    assert row["naturalness"] == pytest.approx(0.3)
    assert row["sets"] == 2


def test_text_and_tables_agree(tmp_path):
    variants = variant_rows(found_by_all(0.2), PLAN.variants(), anchor=0.0)
    sizes = size_rows(readings((5, 10)))
    prepared = SimpleNamespace(
        canonical={"adversarialness": 0.0}, task=SimpleNamespace(horizon=100)
    )
    text = account(PLAN, variants, sizes, prepared)
    assert "- **noise**: `no-noise` raises adversarialness by 0.100, raises auc by" in text
    assert "| passive | 0.20 | 0.10 | 10 |" in text
    assert "| canonical, held out | 1.00 | 1.00 | 5 |" in text
    assert "With the referee every reading has settled from n = 10 on." in text
    assert "{" not in text
    draw(tmp_path / "figure.svg", variants, sizes)
    assert (tmp_path / "figure.svg").stat().st_size > 10_000


def test_a_variant_that_changes_nothing_is_said_not_to_be_told_apart():
    variants = variant_rows(found_by_all(0.0), PLAN.variants(), anchor=0.0)
    prepared = SimpleNamespace(
        canonical={"adversarialness": 0.0}, task=SimpleNamespace(horizon=100)
    )
    text = account(PLAN, variants, size_rows(readings()), prepared)
    assert "`no-noise` cannot be told from the default" in text
    assert "as 0 of 21 do" in text

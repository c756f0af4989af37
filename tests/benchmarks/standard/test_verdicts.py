"""The verdict follows the lower ends of the intervals."""

from __future__ import annotations

import pytest

from benchmarks.standard.plan import LIMIT
from benchmarks.standard.verdicts import verdict, verdict_line


def row(number, difference, low, high, seeds=10):
    return {
        "robot": "vanilla", "number": number, "difference": difference, "difference_low": low,
        "difference_high": high, "seeds": seeds,
    }  # fmt: skip


def two(auc_low, natural_low, **options):
    return [
        row("auc", 0.01, auc_low, 0.05, **options),
        row("auc_natural", 0.01, natural_low, 0.05, **options),
    ]


@pytest.mark.parametrize(
    ("auc_low", "natural_low", "found"),
    [
        pytest.param(-0.01, -0.019, "met", id="both-above"),
        pytest.param(0.03, -LIMIT, "met", id="at-the-limit"),
        pytest.param(-0.021, 0.0, "not met", id="auc-below"),
        pytest.param(0.0, -0.021, "not met", id="auc-natural-below"),
        pytest.param(None, None, "not enough seeds", id="no-interval"),
    ],
)
def test_both_lower_ends_must_keep_the_limit(auc_low, natural_low, found):
    assert verdict(two(auc_low, natural_low)) == found


def test_a_verdict_that_is_met_states_both_numbers():
    assert verdict_line(two(-0.01, -0.015)) == (
        "`vanilla`: **met** (10 seeds): `auc` +0.010 [-0.010, +0.050], "
        "`auc_natural` +0.010 [-0.015, +0.050]."
    )


def test_a_verdict_that_is_not_met_names_what_falls_short():
    assert verdict_line(two(-0.01, -0.04)).startswith(
        "`vanilla`: **not met** by `auc_natural` (10 seeds): `auc` +0.010"
    )
    assert "**not met** by `auc` and `auc_natural` (10" in verdict_line(two(-0.03, -0.04))


def test_a_single_seed_is_not_enough():
    rows = [row(name, -0.3, None, None, seeds=1) for name in ("auc", "auc_natural")]
    assert verdict_line(rows) == (
        "`vanilla`: **not enough seeds** (1 seed): `auc` -0.300, `auc_natural` -0.300."
    )


def test_nothing_measured_is_not_enough():
    rows = [row(name, None, None, None, seeds=0) for name in ("auc", "auc_natural")]
    assert verdict_line(rows) == (
        "`vanilla`: **not enough seeds** (0 seeds): `auc` unknown, `auc_natural` unknown."
    )

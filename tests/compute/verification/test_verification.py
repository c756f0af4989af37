"""`rigid verify` in small: one λ, two seeds, and what must not pass."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rigid.commands.verifying import table
from rigid.compute.verification import cases as verification
from rigid.compute.verification.plan import Plan, plan_verification
from rigid.compute.verification.resting import Effort
from rigid.errors import UserError
from rigid.learning import adversary

SMALL = Effort(seeds=(0, 1), iterations=90, scored=4000)
BRIEF = replace(SMALL, seeds=(0,))  # For what is far off.


def found(case, effort=SMALL):
    (row,) = verification.rows_of(case, effort, lambda _: None)
    return row


@pytest.fixture(scope="module")
def default():
    return verification.cases((8.0,))[0]


def test_the_search_finds_the_exact_optimum(default):
    row = found(default)
    assert row["ok"], row
    assert set(row) >= {
        "task", "setting", "lambda", "shift", "shift_exact", "naturalness", "naturalness_exact",
        "overlap", "overlap_exact",
    }  # fmt: skip


def test_the_printed_penalty_does_not_pass_for_the_default(default):
    row = found(replace(default, penalty="paper_d2"), BRIEF)
    assert not row["ok"]
    assert row["shift"] > row["shift_exact"] + 0.3


def test_a_penalty_of_the_wrong_sign_does_not_pass(default, monkeypatch):
    right = adversary.shaped_reward
    monkeypatch.setattr(adversary, "shaped_reward", lambda weight, r, p: right(weight, r, -p))
    adversary._update.clear_cache()
    try:
        assert not found(default, BRIEF)["ok"]
    finally:
        adversary._update.clear_cache()


@pytest.mark.parametrize("lambda_", [2.9, 0.0, float("inf")])
def test_a_lambda_without_optimum_is_refused(lambda_):
    with pytest.raises(UserError, match=r"--lambdas .*: offset catch has an optimum for λ above 2"):
        plan_verification((lambda_,))


def test_a_row_that_is_off_is_shown_and_decides(default):
    rushed = Plan((default,), replace(SMALL, seeds=(0,), iterations=3), whole=False)
    result = rushed.run(lambda _: None, lambda _: None)
    assert not result["ok"]
    text = table({**result, "wall_seconds": 1.0})
    assert "NO" in text
    assert text.endswith("1 rows are off; 1 s")

"""What is planned, and what the text says of the result."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.reliability.account import criterion, verdict, write_account
from benchmarks.reliability.plan import NUMBERS, Plan
from benchmarks.reliability.spread import Spread, pair_rows, spread_of
from rigid.errors import UserError
from rigid.frontier.comparison import Number
from rigid.presets import PRESETS
from rigid.tasks.registry import make_task

PLAN = Plan(
    task=make_task("analytic/offset-catch"), robot="builtin:catcher", preset=PRESETS["standard"]
)
SPREAD = Spread(
    mean=0.5, measured=0.02, predicted=0.01, ratio=2.0, low=1.2, high=4.0, added=0.017,
    printed=0.03, held=0.8,
)  # fmt: skip


def test_no_two_measurements_share_a_search_seed_nor_take_the_usual_ones():
    seeds = [seed for m in range(1, PLAN.measurements + 1) for seed in PLAN.seeds(m)]
    assert len(seeds) == len(set(seeds)) == 48
    assert not set(seeds) & set(PLAN.preset.seeds)


def test_a_single_measurement_is_refused():
    with pytest.raises(UserError, match="--measurements is 1, but a pair needs 2"):
        replace(PLAN, measurements=1)


def test_a_preset_of_one_seed_is_refused():
    preset = replace(PRESETS["demo"], seeds=(0,))
    with pytest.raises(UserError, match="preset 'demo' has one search seed, which predicts no"):
        replace(PLAN, preset=preset)


@pytest.mark.parametrize(
    ("low", "high", "said"),
    [
        (1.2, 4.0, "differ more than their seeds say, by a factor of 2.00 [1.20, 4.00]"),
        (0.5, 4.0, "cannot be told apart; their ratio is 2.00 [0.50, 4.00]"),
        (0.5, 0.9, "differ less than their seeds say"),
    ],
)
def test_the_verdict_follows_the_interval_of_the_ratio(low, high, said):
    assert said in verdict("auc", SPREAD._replace(low=low, high=high))


def test_seeds_that_do_not_differ_have_a_verdict():
    unknown = SPREAD._replace(ratio=None, low=None, high=None)
    assert verdict("auc", unknown) == (
        "`auc`: seeds do not differ at all, so that they predict nothing."
    )


def test_the_account_says_whether_each_limit_was_kept(tmp_path):
    measured = [
        dict.fromkeys(NUMBERS, Number({"0": mean - 0.01, "1": mean + 0.01}))
        for mean in (0.40, 0.44, 0.45)
    ]
    pairs = pair_rows(measured)
    assert criterion(pairs) == "`worst_at` keeps it, `auc` does not keep it."
    spreads = {name: spread_of([numbers[name] for numbers in measured]) for name in NUMBERS}
    write_account(tmp_path / "README.md", PLAN, spreads, measured, pairs)
    text = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert "90% of pairs differ by less than 0.06 in `worst_at` and 0.03 in `auc`" in text
    assert "| `auc` | 0.430 | 33% | 0.050 |" in text
    assert "{" not in text

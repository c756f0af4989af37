"""Text, tables and figure of planted differences."""

from __future__ import annotations

from dataclasses import replace

from benchmarks.standard.account import account
from benchmarks.standard.costs import cost_rows
from benchmarks.standard.drawing import draw
from benchmarks.standard.pairing import pairs_of, with_pooled
from benchmarks.standard.plan import PLAN
from tests.benchmarks.standard.samples import both, each, rows_of

TWO = (0, 1)
NAMES = [robot.name for robot in PLAN.robots]
SEEDS = PLAN.seeds
MAKERS = {"RIGID 2.0": 4, "RIGID 1.0": 1}


def study(*shifts, seeds=SEEDS):
    """All robots; the attacks of `standard` lie lower by the robot's shift."""
    found = {}
    for name, shift in zip(NAMES, shifts, strict=True):
        paper = {seed: 0.5012 + 0.01 * seed for seed in seeds}
        found[name] = both({seed: height - shift for seed, height in paper.items()}, paper)
    return found


def written(measured, plan=PLAN):
    return account(plan, measured, rows_of(measured), cost_rows(measured), MAKERS)


def test_a_planted_difference_stands_in_verdict_and_table():
    # `auc` falls by half a shift.
    text = written(study(0.0, 0.02, 0.2))
    assert "- `vanilla`: **met** (10 seeds): `auc` +0.000 [+0.000, +0.000], `auc_n" in text
    assert "- `i012-s2`: **met** (10 seeds): `auc` -0.010 [-0.010, -0.010], `auc_n" in text
    assert "- `i100-s7`: **not met** by `auc` and `auc_natural` (10 seeds): `auc` -0.100" in text
    assert "| `auc` | i100-s7 | 10 | 0.623 | 0.723 | -0.100 [-0.100, -0.100] |" in text
    assert "| `auc` | all robots | 10 | 0.686 | 0.723 | -0.037 [-0.037, -0.037] |" in text
    assert "| `worst_at_0.9` | i012-s2 | 10 | 0.526 | 0.546 | -0.020 [-0.020, -0.020] |" in text
    assert "All 30 pairs are complete." in text
    assert "{" not in text


def test_an_account_under_way_says_how_many_pairs_it_has():
    text = written(study(0.0, 0.0, 0.0, seeds=(0, 1, 2)))
    assert "**So far 9 of 30 pairs are complete; the same command goes on, on any machine" in text
    assert "- `vanilla`: **met** (3 seeds)" in text


def test_a_single_seed_has_no_interval_and_no_verdict():
    text = written(study(0.1, 0.1, 0.1, seeds=(0,)))
    assert "- `vanilla`: **not enough seeds** (1 seed): `auc` -0.050, `auc_natural` -0" in text
    assert "| `auc` | all robots | 1 | 0.651 | 0.701 | -0.050 |" in text


def test_the_cost_table_has_the_ratio():
    measured = study(0.0, 0.0, 0.0, seeds=TWO)
    for runs in measured.values():
        runs["paper"] = each(dict.fromkeys(TWO, 0.5), core_seconds=1480, env_steps=10368000)
    text = written(measured)
    assert "| vanilla | 800 | 11,840 | 14.8 | 8,000 | 82,944,000 |" in text
    assert "| all robots | 800 | 11,840 | 14.8 |" in text


def test_it_says_how_each_robot_was_made():
    text = written(study(0.0, 0.0, 0.0, seeds=TWO))
    assert "- `vanilla`: bundled; success with its human 0.98" in text
    assert (
        "- `i012-s2`: as `rigid train vanilla` makes it, 12 iterations of 96 episodes, seed 2; "
        "success with its human 0.98"
    ) in text


def test_both_budgets_are_stated():
    text = written(study(0.0, 0.0, 0.0, seeds=TWO))
    assert "| `paper` | 6 + 6 + 6 | 1e-05 | 120 | 48 | one for each λ | 200 episodes |" in text
    assert "| two for each seed |" in text


def test_a_robot_that_is_not_measured_yet_is_listed_as_unknown():
    measured = {**study(0.0, 0.0, 0.0, seeds=TWO), "i100-s7": {}}
    text = written(measured)
    assert "- `i100-s7`: **not enough seeds** (0 seeds): `auc` unknown" in text
    assert "| `auc` | i100-s7 | 0 | unknown | unknown | unknown |" in text
    assert "**So far 4 of 30 pairs" in text


def test_it_says_with_what_the_parts_were_made():
    text = written(study(0.0, 0.0, 0.0, seeds=TWO))
    assert "\n- 1 with RIGID 1.0\n- 4 with RIGID 2.0\n" in text


def test_a_quick_run_is_stamped():
    text = written(study(0.0, 0.0, 0.0, seeds=TWO), replace(PLAN, stamp="\n*Quick run*\n"))
    assert text.startswith("# Is preset `standard` as good as preset `paper`?\n\n*Quick run*\n")


def test_the_figure_shows_every_seed(tmp_path):
    measured = study(0.0, 0.02, 0.2, seeds=TWO)
    pairs = with_pooled([p for name, runs in measured.items() for p in pairs_of(name, runs)])
    draw(tmp_path / "figure.svg", pairs, rows_of(measured))
    text = (tmp_path / "figure.svg").read_text(encoding="utf-8")
    assert "limit -0.02" in text
    assert "all robots" in text

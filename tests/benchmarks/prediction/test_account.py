"""The account and the figure hold what the tables hold."""

from __future__ import annotations

import re

import pytest

from benchmarks.prediction.account import account
from benchmarks.prediction.assembling import human_rows, table_rows
from benchmarks.prediction.associations import correlation_rows, difference_rows, find
from benchmarks.prediction.drawing import draw
from benchmarks.prediction.plan import PLAN, QUICK
from tests.benchmarks.prediction.samples import HUMANS, subject


@pytest.fixture(scope="module")
def rows():
    subjects = [
        subject(0, 0.9, 0.6, success=0.5),
        subject(1, 0.5, 0.7, success=0.97),
        subject(2, 0.4, 0.3),
        subject(3, 0.3, 0.2),
        subject(4, 0.2, 0.1),
    ]
    return (
        table_rows(subjects, HUMANS),
        human_rows(subjects, HUMANS),
        correlation_rows(subjects, HUMANS, resamples=50),
        difference_rows(subjects, HUMANS, resamples=50),
    )


def test_the_main_table_shows_the_measured_coefficients(rows):
    row = find(
        rows[2], robots="all", humans="all", target="adversarialness", predictor="worst_at_0.9"
    )
    shown = f"| `worst_at_0.9` | {row['tau']:.2f} [{row['tau_low']:.2f}, {row['tau_high']:.2f}] |"
    assert shown in account(PLAN, *rows)


def test_every_robot_and_human_has_its_line(rows):
    text = account(PLAN, *rows)
    assert "| E | 6 | 4 | 0.2 – 0.05 | 1.00 | 0.20 [0.20, 0.20] |" in text
    assert "| female | bodies | 0.10 – 0.30 – 0.70 | 0.30 – 0.70 – 0.90 |" in text


def test_the_account_says_how_auc_compares_and_how_many_robots_are_competent(rows):
    text = account(PLAN, *rows)
    compared = r"^- `(worst_at_0.9|auc)` .*`(auc|worst_at_0.9)`.*difference of τ"
    assert re.search(compared, text, re.MULTILINE)
    assert "only the 4 of 5" in text


def test_nothing_of_the_template_is_left(rows):
    assert not re.search(r"[{}]", account(PLAN, *rows))


def test_a_quick_run_is_stamped(rows):
    stamp = "**quick: shows that the road works and nothing of any robot**"
    assert stamp in account(QUICK, *rows)
    assert stamp not in account(PLAN, *rows)


def test_equal_tables_draw_equal_figures(rows, tmp_path):
    for name in ("a.svg", "b.svg"):
        draw(tmp_path / name, rows[0])
    first = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert first == (tmp_path / "b.svg").read_text(encoding="utf-8")
    assert first.count(">E</text>") == 3  # A point in each panel.

"""What the account says follows the intervals."""

from __future__ import annotations

import pytest

from benchmarks.prediction.verdicts import against, among_competent, told_from_chance


def row(predictor, tau, low, high, p=0.01, n=12):
    return {
        "predictor": predictor, "tau": tau, "tau_low": low, "tau_high": high, "tau_p": p, "n": n,
    }  # fmt: skip


def contrast(difference, low, high):
    return {
        "first": "worst_at_0.9", "second": "auc", "tau_difference": difference,
        "tau_difference_low": low, "tau_difference_high": high,
    }  # fmt: skip


def test_numbers_are_sorted_by_what_interval_and_p_say():
    rows = [
        row("worst_at_0.9", 0.7, 0.2, 0.9), row("auc", 0.3, -0.1, 0.6),
        row("auc_excess", -0.6, -0.9, -0.1), row("auc_paper_axis", None, None, None, None),
    ]  # fmt: skip
    assert told_from_chance(rows) == (
        "Told from chance (interval of τ above 0 and p ≤ 0.05): `worst_at_0.9`; "
        "against the claim, a worse number with fewer failures: `auc_excess`; "
        "not told from chance: `auc`; undefined: `auc_paper_axis`."
    )


def test_a_perfect_ranking_of_four_robots_is_not_told_from_chance():
    assert told_from_chance([row("auc", 1.0, 1.0, 1.0, p=0.083)]) == (
        "Told from chance (interval of τ above 0 and p ≤ 0.05): no number; "
        "not told from chance: `auc`."
    )


@pytest.mark.parametrize(
    ("difference", "words"),
    [
        ((0.4, 0.1, 0.6), "`auc` predicts worse than `worst_at_0.9`: difference of τ +0.40"),
        ((-0.4, -0.6, -0.1), "`worst_at_0.9` predicts worse than `auc`: difference of τ -0.40"),
        ((0.2, -0.1, 0.5), "told apart: difference of τ +0.20 [-0.10, 0.50]; `worst_at_0.9` is ah"),
        ((-0.2, -0.5, 0.1), "`auc` is ahead in this sample."),
        ((0.0, -0.5, 0.1), "neither is ahead."),
        ((None, None, None), "cannot be compared: one of them is undefined here."),
    ],
)  # fmt: skip
def test_a_contrast_is_decided_by_its_interval(difference, words):
    assert words in against(contrast(*difference))


def test_too_few_competent_robots_are_not_ranked():
    assert among_competent([row("auc", None, None, None, None, n=2)]) == (
        "Competent robots: 2, too few to rank."
    )


def test_competent_robots_are_judged_alike():
    text = among_competent([row("auc", 0.7, 0.2, 0.9, n=8)])
    assert text.startswith("Competent robots alone (8). Told from chance")

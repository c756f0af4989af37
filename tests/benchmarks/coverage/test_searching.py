"""From a measured frontier to one row for each seed."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.coverage.searching import rows_of
from rigid.frontier.result import Frontier


def point(seed, lambda_, naturalness, adversarialness):
    return {
        "id": f"s{seed}-{lambda_}", "seed": seed, "lambda": lambda_, "naturalness": naturalness,
        "naturalness_own": None, "adversarialness": adversarialness, "faults": 0, "episodes": 10,
    }  # fmt: skip


def test_a_row_holds_the_numbers_of_its_seed_and_the_lambda_of_its_worst():
    points = [
        point(3, 0.1, 0.5, 0.9), point(3, 0.5, 0.9, 0.4), point(3, 2.0, 0.95, 0.3),
        point(4, 0.1, 0.5, 0.8),
    ]  # fmt: skip
    data = {
        "points": points, "auc_by_seed": {"3": 0.0, "4": 0.0}, "canonical": {"adversarialness": 0.1}
    }  # fmt: skip
    first, second = rows_of(Frontier(Path("run"), data), 1.5, [3, 4])
    assert (first["tolerance"], first["seed"]) == (1.5, 3)
    assert (first["worst_at"], first["worst_lambda"]) == (0.4, 0.5)
    assert first["hull_at"] == pytest.approx(0.4)
    # No point is natural enough: canonical play sets the one, a mixture with it the other.
    assert (second["worst_at"], second["worst_lambda"]) == (0.1, None)
    assert second["hull_at"] == pytest.approx(0.8 - 0.7 * 0.8)

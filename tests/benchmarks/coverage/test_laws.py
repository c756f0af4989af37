"""Laws: their means are exact, and they stay where headline numbers stay."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.coverage.laws import LAWS, beta, log_normal


@pytest.mark.parametrize("law", [*LAWS, log_normal(0.3, 1.0)], ids=lambda law: law.name)
def test_the_mean_is_that_of_the_draws(law):
    values = law.sample(np.random.default_rng(5), (200_000,))
    assert law.mean == pytest.approx(values.mean(), abs=4 * values.std() / len(values) ** 0.5)
    assert values.min() >= 0.0
    assert values.max() <= 1.0


def test_skewness_of_a_beta_law_is_the_textbook_one():
    a, b = 1, 9
    exact = 2 * (b - a) * (a + b + 1) ** 0.5 / ((a + b + 2) * (a * b) ** 0.5)
    assert beta(a, b).skewness() == pytest.approx(exact, abs=0.02)

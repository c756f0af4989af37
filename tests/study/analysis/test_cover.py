"""Do the intervals cover, and does the test of equivalence err as often as it says?"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import expit
from scipy.stats import norm

from rigid.study.analysis.clustered import clustered_mean
from rigid.study.analysis.equivalence import equivalence

STUDIES = 1500
"""Of each setting: their share is known to 1.2 percentage points (95 %) where it is 0.05."""


def studies(share, raters, pairs, spread, seed):
    """Choices of raters and pairs drawn anew, with this share on average over both."""
    rng = np.random.default_rng(seed)
    # With a probit link the mean over normal intercepts is known: Φ(μ / √(1 + σ²)).
    mean = norm.ppf(share) * (1 + 2 * spread**2) ** 0.5
    rows, columns = np.divmod(np.arange(raters * pairs), pairs)
    for _ in range(STUDIES):
        level = mean + spread * (rng.normal(size=raters)[rows] + rng.normal(size=pairs)[columns])
        yield (rng.normal(size=len(rows)) < level).astype(float), rows, columns


@pytest.mark.slow
@pytest.mark.parametrize("spread", [0.0, 0.3, 0.7])
@pytest.mark.parametrize(("raters", "pairs"), [(15, 30), (5, 30)])
def test_at_the_edge_of_the_margin_the_test_says_equivalent_in_5_percent_at_most(
    raters, pairs, spread
):
    wrong = [
        equivalence(*one, margin=0.1).verdict == "equivalent"
        for one in studies(0.6, raters, pairs, spread, seed=1)
    ]
    assert np.mean(wrong) <= 0.065


# A limit of the method, so the threshold stays and strictness tells when it no longer holds.
FEW_AND_FAR_APART = pytest.mark.xfail(
    strict=True, reason="five raters of strong taste: 92.7 % of 1,500; docs/study.md says so"
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("raters", "pairs", "spread"),
    [
        (15, 30, 0.0), (15, 30, 0.3), (15, 30, 0.7), (5, 30, 0.0), (5, 30, 0.3),
        pytest.param(5, 30, 0.7, marks=FEW_AND_FAR_APART),
    ],
)  # fmt: skip
def test_the_interval_of_a_preference_covers_93_percent_at_least(raters, pairs, spread):
    covered = []
    for one in studies(0.6, raters, pairs, spread, seed=2):
        low, high = clustered_mean(*one).interval(0.95, (0.0, 1.0))
        covered.append(low <= 0.6 <= high)
    assert np.mean(covered) >= 0.93


@pytest.mark.slow
def test_scores_of_few_raters_on_few_pairs_are_covered():
    rng = np.random.default_rng(3)
    rows, columns = np.divmod(np.arange(5 * 30), 30)
    covered = []
    for _ in range(STUDIES):
        level = 1.0 * rng.normal(size=5)[rows] + 0.5 * rng.normal(size=30)[columns]
        scores = np.round(7 * expit(level + rng.logistic(size=150)))
        low, high = clustered_mean(scores, rows, columns).interval(0.95, (0.0, 7.0))
        covered.append(low <= 3.5 <= high)
    assert np.mean(covered) >= 0.93

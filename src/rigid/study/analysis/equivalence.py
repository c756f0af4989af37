"""Faithfulness as equivalence: is there *no* preference, by a margin that was fixed beforehand?

Section 5.2 shows people a recorded motion and one that RIGID found, of the same naturalness, and
asks which is closer to the reference. That a test finds no difference would prove nothing: a study
that is small enough never does. So the claim is tested that the preference lies within a margin of
one half, by two one-sided tests (Schuirmann, J. Pharmacokin. Biopharm. 15, 1987). Ours; the paper
shows bars.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float, Int
from scipy.special import stdtr

from rigid.frontier.intervals import Interval
from rigid.study.analysis.clustered import ClusteredMean, clustered_mean

Verdict = Literal["equivalent", "different", "undecided", "unknown"]
NO_PREFERENCE = 0.5


@dataclass(frozen=True, kw_only=True)
class Equivalence:
    """What a set of choices between two says of preference."""

    share: ClusteredMean
    """Of answers that chose the pair's second member, the recorded one."""
    margin: float
    interval: Interval | None
    """With the confidence of the settings (95 %)."""
    interval_of_test: Interval | None
    """With 1 - 2α (90 %): within the margin exactly where the test says 'equivalent'."""
    p_equivalence: float | None
    """The larger of the two one-sided p-values."""
    p_difference: float | None
    """Two-sided, of the hypothesis that there is no preference at all."""
    verdict: Verdict
    """`equivalent`: within the margin. `different`: the interval excludes one half, and the test
    of equivalence fails. `undecided`: too few answers to say either. `unknown`: no interval."""


def equivalence(
    chose_recorded: Float[np.ndarray, " n"],
    raters: Int[np.ndarray, " n"],
    pairs: Int[np.ndarray, " n"],
    *,
    margin: float,
    confidence: float = 0.95,
) -> Equivalence:
    """Tests whether the preference for the recorded member is within `margin` of one half.

    Args:
        chose_recorded: 1 where the pair's second member was chosen, else 0. Shape (n,), n >= 1.
        raters: Who answered. Shape (n,).
        pairs: About which pair. Shape (n,).
        margin: In (0, 1/2).
        confidence: 1 - α.

    Raises:
        ValueError: There are no answers.

    Example:
        >>> raters, pairs = np.divmod(np.arange(600), 20)
        >>> equivalence((raters + pairs) % 2.0, raters, pairs, margin=0.1).verdict
        'equivalent'
    """
    share = clustered_mean(chose_recorded, raters, pairs)
    alpha = 1.0 - confidence
    interval = share.interval(confidence, (0.0, 1.0))
    if interval is None:
        return Equivalence(
            share=share, margin=margin, interval=None, interval_of_test=None,
            p_equivalence=None, p_difference=None, verdict="unknown",
        )  # fmt: skip
    above, below = (_beyond(share, NO_PREFERENCE + side * margin, -side) for side in (-1, 1))
    p_equivalence = max(above, below)
    p_difference = 2 * min(_beyond(share, NO_PREFERENCE, 1), _beyond(share, NO_PREFERENCE, -1))
    verdict: Verdict = "undecided"
    if p_equivalence < alpha:
        verdict = "equivalent"
    elif p_difference < alpha:
        verdict = "different"
    return Equivalence(
        share=share, margin=margin, interval=interval,
        interval_of_test=share.interval(1 - 2 * alpha, (0.0, 1.0)),
        p_equivalence=p_equivalence, p_difference=min(p_difference, 1.0), verdict=verdict,
    )  # fmt: skip


def _beyond(share: ClusteredMean, limit: float, side: int) -> float:
    """P-value of the hypothesis that the share lies below `limit` (side 1) or above it (-1)."""
    assert share.se is not None
    assert share.freedom is not None
    distance = side * (share.mean - limit)
    if share.se == 0.0:  # Everybody always gave the same answer.
        return 0.0 if distance > 0 else 1.0
    return float(stdtr(share.freedom, -distance / share.se))

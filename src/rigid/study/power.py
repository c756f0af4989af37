"""How large a study must be: raters and pairs are drawn, asked, and analysed, again and again.

A simulated study is analysed by the very functions that analyse a real one, so that its power is
that of `rigid study analyze`. Answers of one rater are alike, and so are answers about one pair;
whoever plans as if all were independent plans a study that cannot say anything.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float, Int
from scipy.optimize import brentq
from scipy.special import expit

from rigid.study.analysis.clustered import clustered_mean
from rigid.study.analysis.equivalence import equivalence

_QUADRATURE = 41
"""Nodes of Gauss and Hermite's rule, for means over normal effects: exact to 1e-9 here."""


class Asked(NamedTuple):
    """The answers of one simulated study."""

    values: Float[np.ndarray, " n"]
    raters: Int[np.ndarray, " n"]
    pairs: Int[np.ndarray, " n"]


class Size(NamedTuple):
    """How many are asked about how much."""

    raters: int
    pairs: int
    """All raters judge the same ones."""


class Power(NamedTuple):
    """How often simulated studies of one size succeed."""

    size: Size
    share: float
    error: float
    """Standard error of `share` from the number of simulations, by Wilson's rule at 0 and 1."""


@dataclass(frozen=True, kw_only=True)
class ChoiceDesign:
    """Which of two motions of one naturalness matches the reference: is there no preference?"""

    preference: float = 0.5
    """True share of answers, over all raters and pairs, that choose the person's motion."""
    margin: float = 0.1
    """Of equivalence; as in `AnalysisSettings`."""
    sd_raters: float = 0.3
    """How raters differ in their preference, standard deviation in log odds. Ours: most raters'
    own share then lies within 0.15 of the mean."""
    sd_pairs: float = 0.5
    """How pairs differ, likewise. Ours: within 0.25 of the mean."""
    confidence: float = 0.95
    """The test has size 1 - confidence."""

    def ask(self, size: Size, rng: np.random.Generator) -> Asked:
        """One study: 1 where the person's motion was chosen, else 0."""
        raters, pairs = _asked(size)
        spread = math.hypot(self.sd_raters, self.sd_pairs)
        odds = (
            _log_odds(self.preference, spread)
            + rng.normal(0.0, self.sd_raters, size.raters)[raters]
            + rng.normal(0.0, self.sd_pairs, size.pairs)[pairs]
        )
        return Asked((rng.random(len(odds)) < expit(odds)).astype(float), raters, pairs)

    def succeeds(self, asked: Asked) -> bool:
        """Whether the two one-sided tests find equivalence."""
        found = equivalence(*asked, margin=self.margin, confidence=self.confidence)
        return found.verdict == "equivalent"


@dataclass(frozen=True, kw_only=True)
class ScaleDesign:
    """Scales from 0 to 7 about both motions of a pair: does the second score higher?

    Of what `rigid study analyze` tells, this is the mean difference within pairs, with the error of
    raters and pairs drawn anew. Its ordinal mixed models take too long to be fitted thousands of
    times.
    """

    scales: Literal[1, 2] = 1
    """2: danger, whose score is one scale minus another; 1: naturalness."""
    difference: float = 1.0
    """True mean difference of scores between a pair's members, in points of a scale."""
    sd_raters: float = 0.5
    """How raters differ in the difference they see, in points. Ours, as what follows."""
    sd_pairs: float = 1.0
    """How pairs differ in it, in points."""
    sd_answers: float = 1.5
    """What is left of one answer, in points, before it is rounded to the scale."""
    confidence: float = 0.95
    """The test has size 1 - confidence, both sides together."""

    def ask(self, size: Size, rng: np.random.Generator) -> Asked:
        """One study: for each rater and pair the score of the second member minus the first's."""
        raters, pairs = _asked(size)
        shift = (
            self.difference
            + rng.normal(0.0, self.sd_raters, size.raters)[raters]
            + rng.normal(0.0, self.sd_pairs, size.pairs)[pairs]
        )
        score = np.zeros(len(shift))
        for scale in range(self.scales):
            sign = 1.0 if scale == 0 else -1.0  # Danger counts, achieving the goal counts against.
            for member in (1.0, -1.0):
                level = 3.5 + sign * member * shift / (2 * self.scales)
                answer = np.rint(level + rng.normal(0.0, self.sd_answers, len(shift)))
                score += sign * member * np.clip(answer, 0, 7)
        return Asked(score, raters, pairs)

    def succeeds(self, asked: Asked) -> bool:
        """Whether the interval of the mean difference lies above zero."""
        interval = clustered_mean(*asked).interval(self.confidence, (-14.0, 14.0))
        return interval is not None and interval.low > 0.0


Design = ChoiceDesign | ScaleDesign


def power(
    design: Design,
    size: Size,
    *,
    simulations: int,
    seed: int,
    tick: Callable[[], None] = lambda: None,
) -> Power:
    """How often a study of one size succeeds.

    Args:
        design: What is asked, and what is true.
        size: Of the study, at least two raters and two pairs.
        simulations: Studies to draw.
        seed: They come from it and from the size alone, whatever else is simulated.
        tick: Called after each.
    """
    rng = np.random.default_rng([seed, *size])
    successes = 0
    for _ in range(simulations):
        successes += design.succeeds(design.ask(size, rng))
        tick()
    share = successes / simulations
    middle = (successes + 2) / (simulations + 4)  # So that 0 and 1 have an error as well.
    return Power(size, share, math.sqrt(middle * (1 - middle) / (simulations + 4)))


def smallest(powers: Iterable[Power], wanted: float) -> tuple[Power, ...]:
    """The sizes that reach a power, and of which no smaller one does; by number of raters.

    Args:
        powers: Of any sizes.
        wanted: Power, in (0, 1).
    """
    reached = [found for found in powers if found.share >= wanted]

    def beaten(one: Power) -> bool:
        mine = (one.size.raters, one.size.pairs)
        return any(
            other.size.raters <= mine[0] and other.size.pairs <= mine[1]
            and (other.size.raters, other.size.pairs) != mine
            for other in reached
        )  # fmt: skip

    return tuple(sorted(one for one in reached if not beaten(one)))


def _asked(size: Size) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """Who answers about which pair."""
    raters, pairs = np.divmod(np.arange(size.raters * size.pairs), size.pairs)
    return raters, pairs


@functools.lru_cache
def _log_odds(share: float, spread: float) -> float:
    """The mean log odds that give `share` on average, where they differ with `spread`.

    Example:
        >>> round(_log_odds(0.5, 1.0), 6), round(float(expit(_log_odds(0.6, 0.0))), 6)
        (0.0, 0.6)
    """
    nodes, weights = np.polynomial.hermite_e.hermegauss(_QUADRATURE)
    weights = weights / weights.sum()

    def excess(mean: float) -> float:
        return float(weights @ expit(mean + spread * nodes)) - share

    return float(brentq(excess, -40.0, 40.0))

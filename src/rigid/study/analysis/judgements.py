"""What those who judged found: with everybody, and without inattentive raters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rigid.data.pair_file import Pair
from rigid.frontier.intervals import Interval
from rigid.study.analysis.agreement import Agreement, agreement
from rigid.study.analysis.attention import Attention, attention, who_failed
from rigid.study.analysis.clustered import ClusteredMean, clustered_mean
from rigid.study.analysis.equivalence import Equivalence, equivalence
from rigid.study.analysis.judged import Asked, Scores, choices_of, differences_of, scores_of
from rigid.study.analysis.ordinal import OrdinalFit, fit_ordinal
from rigid.study.analysis.settings import AnalysisSettings
from rigid.study.records import Answer, Kind

WIDTHS = {"danger": 14.0, "naturalness": 7.0}
"""How far two scores may lie apart: danger minus goal goes from -7 to 7."""


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """A mean over answers with its interval over raters and pairs; None where one is all."""

    mean: float
    interval: Interval | None
    answers: int
    raters: int
    pairs: int


@dataclass(frozen=True, kw_only=True)
class ChoiceFindings:
    """Which of two is closer to the reference."""

    preference: Equivalence
    by_rater: tuple[float, ...]
    """Share of each rater that chose the recorded member."""
    left: Estimate
    """Share that chose what stood on the left: one half but for chance, since sides were drawn."""
    agreement: Agreement


@dataclass(frozen=True, kw_only=True)
class ScoreFindings:
    """Scores on a scale."""

    levels: tuple[Estimate, Estimate]
    """Of the pair's first and of its second member, which has more of the axis."""
    difference: Estimate
    """Second minus first, by rater and pair; needs no model."""
    model: OrdinalFit
    agreement: Agreement
    scores: Scores
    """For the plot."""


@dataclass(frozen=True, kw_only=True)
class Judged:
    """One questionnaire."""

    question: Asked
    pairs: str
    """Name of the pair file."""
    of: Kind
    """Whether people judged, or scripts in a pilot."""
    checks: tuple[Attention, ...]
    everybody: ChoiceFindings | ScoreFindings
    """The headline: nobody is left out after the fact."""
    attentive: ChoiceFindings | ScoreFindings | None
    """Without those who failed a check; None where nobody did, or nobody is left."""


def judge(
    question: Asked,
    name: str,
    answers: Sequence[Answer],
    pairs: Sequence[Pair],
    settings: AnalysisSettings,
    *,
    of: Kind = "person",
    say: Callable[[str], None] = lambda _: None,
) -> Judged | None:
    """Analyses one questionnaire; None where nobody answered.

    Args:
        question: What was asked.
        name: Of the pair file.
        answers: To this questionnaire.
        pairs: What was shown.
        settings: Margin, levels, budget.
        of: Who judged.
        say: Told of what takes long.
    """
    checks = attention(answers)
    failed = who_failed(checks)
    everybody = _findings(question, answers, pairs, settings, say)
    if everybody is None:
        return None
    kept = [answer for answer in answers if answer.participant not in failed]
    return Judged(
        question=question, pairs=name, of=of, checks=tuple(checks), everybody=everybody,
        attentive=_findings(question, kept, pairs, settings, say) if failed else None,
    )  # fmt: skip


def _findings(
    question: Asked,
    answers: Sequence[Answer],
    pairs: Sequence[Pair],
    settings: AnalysisSettings,
    say: Callable[[str], None],
) -> ChoiceFindings | ScoreFindings | None:
    if question == "correspondence":
        return _choices(answers, settings)
    scores = scores_of(answers, question, pairs)
    if not len(scores.score):
        return None
    say(f"{question}: fitting a mixed model to {len(scores.score)} scores")
    return _scores(question, scores, settings)


def _choices(answers: Sequence[Answer], settings: AnalysisSettings) -> ChoiceFindings | None:
    chosen = choices_of(answers)
    second, rater, pair, left = chosen
    if not len(second):
        return None
    level = settings.confidence
    return ChoiceFindings(
        preference=equivalence(second, rater, pair, margin=settings.margin, confidence=level),
        by_rater=tuple(float(second[rater == one].mean()) for one in np.unique(rater)),
        left=_estimate(clustered_mean(left, rater, pair), level, (0.0, 1.0)),
        agreement=agreement(
            second, rater, pair, pair, scale="nominal", confidence=level
        ),
    )  # fmt: skip


def _scores(question: Asked, scores: Scores, settings: AnalysisSettings) -> ScoreFindings:
    width, level = WIDTHS[question], settings.confidence
    low = -7.0 if question == "danger" else 0.0
    each = [scores.keep(scores.second == number) for number in (0, 1)]
    means = [
        _estimate(clustered_mean(s.score, s.rater, s.pair), level, (low, low + width))
        for s in each if len(s.score)
    ]  # fmt: skip
    apart, rater, pair = differences_of(scores)
    empty = Estimate(mean=float("nan"), interval=None, answers=0, raters=0, pairs=0)
    first, second = (means + [empty, empty])[:2]
    return ScoreFindings(
        levels=(first, second),
        difference=(
            _estimate(clustered_mean(apart, rater, pair), level, (-width, width))
            if len(apart) else empty
        ),
        model=fit_ordinal(
            scores, chains=settings.chains, samples=settings.samples, seed=settings.seed,
            confidence=level,
        ),
        agreement=agreement(
            scores.score, scores.rater, scores.member, scores.pair, scale="ordinal",
            confidence=level,
        ),
        scores=scores,
    )  # fmt: skip


def _estimate(found: ClusteredMean, confidence: float, bounds: tuple[float, float]) -> Estimate:
    return Estimate(
        mean=found.mean, interval=found.interval(confidence, bounds), answers=found.answers,
        raters=found.raters, pairs=found.pairs,
    )  # fmt: skip

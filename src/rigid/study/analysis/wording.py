"""What an analysis found, in sentences: for the terminal and for the page.

Never that a frontier holds every failure there is, since no number of people can show that.
"""

from __future__ import annotations

from math import exp

from rigid.frontier.intervals import Interval
from rigid.frontier.standings import TITLES
from rigid.study.analysis.agreement import Agreement
from rigid.study.analysis.counting import Control, Count
from rigid.study.analysis.dominance import Share
from rigid.study.analysis.equivalence import Equivalence
from rigid.study.analysis.judgements import ChoiceFindings, Estimate, Judged, ScoreFindings
from rigid.study.analysis.ordinal import OrdinalFit
from rigid.study.analysis.robots import RobotOrder, RobotPair
from rigid.study.analysis.whole import Analysis

STEP = 0.3
"""Of an axis, for odds ratios: what members of a pair differ by at least (`frontier.pairs`)."""
AXIS_OF = {"danger": "adversarialness", "naturalness": "naturalness"}
"""Along which axis a score should rise."""
QUESTIONS = {
    "correspondence": "faithfulness",
    "danger": "danger",
    "naturalness": "naturalness as people see it",
}


_READING = (
    (
        "naturalness of people is an upper bound: by the strictest of the referees that the "
        "robot's runs stored, chosen on one half of their episodes and asked about the other"
    ),
    (
        "a person lies above the frontier when no adversary, and not canonical play, is at least "
        "as natural and at least as adversarial (the steps in the figure); 'at most' is the upper "
        "95 % Clopper-Pearson bound on the share of such people, and bounds nothing for others"
    ),
    ("the hull is what a human attains who mixes two ways of moving from episode to episode"),
)


def sentences(analysis: Analysis) -> list[str]:
    """The findings, most important first."""
    lines = [_above(count) for count in analysis.counts if count.claim]
    lines += [_no_claim(control) for control in analysis.controls if not control.claim]
    for judged in analysis.judged:
        lines += [f"{title_of(judged)}: {line}" for line in judged_lines(judged)]
    return lines + order_lines(analysis.order)


def notes(analysis: Analysis) -> list[str]:
    """How to read them, and what was not as planned."""
    floor = analysis.settings.benign_floor
    quantile = analysis.settings.episode_quantile
    lines: list[str] = []
    if analysis.placed:
        lines += _READING
        lines.append(
            f"single episodes are held against the {100 * quantile:g} % quantiles of the "
            "adversaries' episodes, not against means"
        )
        lines.append(
            f"devices are kept apart; where benign players score below {floor:g}, nothing is "
            "claimed"
        )
    if any(placed.on_device is not None for placed in analysis.placed):
        lines.append(
            "'x against practice' puts benign play on the same kind of device in the place of "
            "canonical data: what both owe to the device then counts for nothing, and a person is "
            "held against adversaries as natural as the larger of both bounds"
        )
    if analysis.scripted:
        lines.append(f"{analysis.scripted} scripted participant(s): shown as such, counted nowhere")
    if any(judged.of == "scripted" for judged in analysis.judged):
        lines.append("questionnaires were answered by scripts alone: a pilot, no finding")
    if analysis.unmeasured:
        named = ", ".join(analysis.unmeasured)
        lines.append(f"no run was named for robot {named}: whoever met it is not placed")
    if analysis.withdrawn:
        lines.append(f"{analysis.withdrawn} participant(s) withdrew and are deleted")
    lines.append(_registration(analysis))
    return lines


def title_of(judged: Judged) -> str:
    """What a questionnaire is called."""
    by = ", answered by scripts" if judged.of == "scripted" else ""
    return f"{QUESTIONS[judged.question]} ({judged.pairs}){by}"


def judged_lines(judged: Judged) -> list[str]:
    """What one questionnaire found."""
    lines = _findings(judged.everybody, judged.question)
    failed = [check.participant for check in judged.checks if check.failed]
    if failed:
        left = "; nobody else answered" if judged.attentive is None else ""
        lines.append(f"{', '.join(failed)} failed an attention check{left}")
    elif judged.checks:
        lines.append(f"all {len(judged.checks)} raters passed every attention check")
    if judged.attentive is not None:
        without = _findings(judged.attentive, judged.question)
        lines += [f"without them: {line}" for line in without]
    return lines


def order_lines(order: RobotOrder | None) -> list[str]:
    """What two robots or more say of each other."""
    if order is None:
        return []
    lines = [_ordered(pair) for pair in order.pairs]
    if order.p is not None:
        lines.append(
            f"all robots: failures of {order.people} people who met them all follow the order of "
            f"'worst at' with p = {order.p:.3f} (two-sided, by permutation)"
        )
    return lines


def spoken_share(share: Share) -> str:
    """As `k of n, at most p %`.

    Example:
        >>> spoken_share(Share(0, 8, 0.3123))
        '0 of 8, at most 31 %'
    """
    if share.at_most is None:
        return "nobody"
    return f"{share.above} of {share.of}, at most {100 * share.at_most:.0f} %"


def spoken_interval(interval: Interval | None, form: str = ".2f") -> str:
    """As `0.41 to 0.60`.

    Example:
        >>> spoken_interval(Interval(0.4, 0.6)), spoken_interval(None)
        ('0.40 to 0.60', 'no interval')
    """
    if interval is None:
        return "no interval"
    return f"{interval.low:{form}} to {interval.high:{form}}"


def spoken_estimate(found: Estimate, form: str = ".2f") -> str:
    """A mean with its interval."""
    return f"{found.mean:{form}} ({spoken_interval(found.interval, form)})"


def spoken_agreement(found: Agreement) -> str:
    """Krippendorff's alpha."""
    if found.alpha is None:
        return "agreement is undefined"
    return f"agreement α = {found.alpha:.2f} ({spoken_interval(found.interval)})"


def spoken_preference(found: Equivalence) -> str:
    """What the test of equivalence says."""
    share, m = found.share, found.margin
    seen = (
        f"{share.mean:.2f} chose the recorded motion ({spoken_interval(found.interval)}; "
        f"{share.answers} answers of {share.raters} raters on {share.pairs} pairs)"
    )
    said = {
        "equivalent": f"no preference, within {m:g} of one half",
        "different": f"a preference, not within {m:g} of one half",
        "undecided": f"whether it lies within {m:g} of one half is undecided",
        "unknown": "too few raters or pairs to tell",
    }[found.verdict]
    if found.p_equivalence is None:
        return f"{seen}: {said}"
    return f"{seen}: {said} (two one-sided tests, p = {found.p_equivalence:.3f})"


def spoken_model(fit: OrdinalFit, question: str) -> str:
    """What the mixed model says of the axis that matters."""
    if fit.refused is not None:
        return f"mixed model refused: {fit.refused}"
    axis = AXIS_OF[question]
    slope = fit.slopes[axis]
    ratio, low, high = (
        _odds(value) for value in (slope.log_odds, slope.interval.low, slope.interval.high)
    )
    return (
        f"the odds of a higher score change by × {ratio} ({low} to {high}) for each {STEP:g} of "
        f"{axis} (cumulative logit mixed model; R-hat {fit.r_hat:.3f}, effective samples "
        f"{fit.ess:.0f})"
    )


def _odds(slope: float) -> str:
    return f"{exp(slope * STEP):.3g}"


def _above(count: Count) -> str:
    return (
        f"robot {count.robot}, {count.role} ({count.device}): {spoken_share(count.people)}, lie "
        f"above the frontier; {count.clearly} by more than their episodes scatter, "
        f"{count.above_hull} above its hull as well; {count.episodes_above} of {count.episodes} "
        "episodes lie above those of every adversary as natural"
    )


def _no_claim(control: Control) -> str:
    return f"robot {control.robot}, {control.device}: no claim, since {control.why}"


def _findings(found: ChoiceFindings | ScoreFindings, question: str) -> list[str]:
    if isinstance(found, ChoiceFindings):
        left = f"the left one was chosen by {spoken_estimate(found.left)}"
        return [
            spoken_preference(found.preference), f"{spoken_agreement(found.agreement)}; {left}"
        ]  # fmt: skip
    apart = spoken_estimate(found.difference, "+.2f")
    return [
        f"the second of a pair, with more {AXIS_OF[question]}, scores {apart} more",
        spoken_model(found.model, question),
        spoken_agreement(found.agreement),
    ]


def _ordered(pair: RobotPair) -> str:
    both = f"robots {pair.first} and {pair.second}"
    people = pair.people
    if people.mean is None or people.p is None:
        return f"{both}: nobody met both"
    seen = (
        f"with the {people.people} people who met both, {pair.second} fails in "
        f"{100 * people.mean:+.0f} percentage points of episodes (p = {people.p:.3f})"
    )
    if pair.why is not None:
        return f"{both}: {seen}; {pair.why}"
    first = pair.headlines[0]
    ends = spoken_interval(first.interval, "+.3f")
    apart = f"{TITLES[first.name]} differs by {first.mean:+.3f} ({ends})"
    return f"{both}: {seen}; {apart}: {_verdict(first.verdict)}"


def _verdict(said: str) -> str:
    return {
        "same order": "people agree with the measurement",
        "opposite order": "people disagree with the measurement",
        "unknown": "one search seed alone tells no order",
    }.get(said, said)


def _registration(analysis: Analysis) -> str:
    margin = analysis.settings.margin
    if analysis.registered is None:
        return f"no analysis was registered before the first participant; margin {margin:g}"
    if analysis.registered:
        return (
            f"the analysis, margin {margin:g} included, was registered before the first participant"
        )
    return (
        f"this is not the analysis that was registered before the first participant (margin now "
        f"{margin:g}): its tests confirm nothing"
    )

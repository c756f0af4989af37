"""What a study asks of people, in words, and what it cannot show as it is planned."""

from __future__ import annotations

from collections.abc import Iterator

from rigid.study.plan import (
    JudgeStage,
    PlayStage,
    PractiseStage,
    Role,
    Stage,
    StudyPlan,
    WatchStage,
)

_BEFORE = 180.0
"""Consent and demographics [s]. Ours, as the two below: guesses, to be replaced by a pilot's."""
_PAUSE = 8.0
"""Between two episodes [s]."""
_ANSWER = {"correspondence": 15.0, "naturalness": 25.0, "danger": 40.0}
"""One trial: one choice, two scales, four scales [s]."""


def overview(plan: StudyPlan, *, episode_seconds: float) -> list[str]:
    """A line for each role: how many, what they do, and how long that takes them.

    Args:
        plan: The study's.
        episode_seconds: Length of an episode [s].
    """
    width = max(len("role"), *map(len, plan.roles))
    lines = [f"{'role':{width}}  people  minutes  does"]
    for name, role in plan.roles.items():
        minutes = _seconds(plan, role, episode_seconds) / 60
        steps = "consent, " + ("demographics, " if plan.demographics else "")
        does = steps + ", ".join(_said(stage, len(plan.robots)) for stage in role.stages)
        lines.append(f"{name:{width}}  {role.participants:6}  {f'≈ {minutes:.0f}':>7}  {does}")
    return lines


def advice(plan: StudyPlan) -> list[str]:
    """What the study could not show, and what would mend it."""
    return [line for name, role in plan.roles.items() for line in _of_role(name, role)] + [
        *(_of_consent(plan)),
    ]


def _of_role(name: str, role: Role) -> Iterator[str]:
    kinds = [stage.kind for stage in role.stages]
    if "play" in kinds and "practise" not in kinds[: kinds.index("play")]:
        yield (
            f"{name}: nobody practises before they play, so that nothing can be claimed of their "
            "device: add - {kind: practise, episodes: 2}"
        )
    practised = sum(s.episodes for s in role.stages if isinstance(s, PractiseStage))
    if "play" in kinds and practised == 1:
        yield (
            f"{name}: practises once, which does not tell the device from the person: ask for "
            "{kind: practise, episodes: 2} or more"
        )
    if kinds[0] != "watch":
        yield f"{name}: begins without canonical episodes: add - {{kind: watch, episodes: 3}}"
    for stage in role.stages:
        if isinstance(stage, JudgeStage) and not stage.attention_checks:
            yield (
                f"{name}: {stage.question} has no attention checks, so that careless raters count "
                "like others"
            )
        if isinstance(stage, JudgeStage) and role.participants < 2:
            yield f"{name}: one rater alone gives no interval over raters"


def _of_consent(plan: StudyPlan) -> Iterator[str]:
    if plan.consent.text is None:
        yield "consent: uses the text that RIGID brings: your ethics board wants its own"
    if plan.consent.contact is None:
        yield "consent: names nobody to ask, nor to withdraw with: add contact: …"


def _said(stage: Stage, robots: int) -> str:
    each = f" with each of {robots} robots" if robots > 1 else ""
    match stage:
        case WatchStage():
            return f"watch {stage.episodes}"
        case PractiseStage():
            return f"practise {stage.episodes}{each}"
        case PlayStage():
            manner = "in their own way" if stage.manner == "own-way" else "to make it fail"
            return f"play {stage.episodes}{each} {manner}"
    more = f" + {stage.attention_checks}" if stage.attention_checks else ""
    return f"judge {stage.question} of {stage.count}{more} pairs ({stage.show}s)"


def _seconds(plan: StudyPlan, role: Role, episode: float) -> float:
    total = _BEFORE
    for stage in role.stages:
        match stage:
            case WatchStage():
                total += stage.episodes * episode
            case PractiseStage() | PlayStage():
                total += stage.episodes * len(plan.robots) * (episode + _PAUSE)
            case JudgeStage():
                total += (stage.count + stage.attention_checks) * _ANSWER[stage.question]
    return total

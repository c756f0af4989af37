"""Which pairs a participant judges, in which order, and on which side each member stands.

All of it follows from the study's seed and the participant's code, so that a page that is reloaded,
or a server that starts again, goes on where the participant was. Draws are hashes: no library's
next version can change them in the middle of a study.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

from rigid.errors import UserError
from rigid.study.judging.clip_names import ClipName, Place, clip_of
from rigid.study.judging.questionnaire import Check, Questionnaire, questionnaire
from rigid.study.judging.questions import Side
from rigid.study.plan import JudgeQuestion, JudgeStage, StudyPlan
from rigid.study.records import Participant

PREVIEW = "preview"
"""Stands for the code of somebody who is no participant."""
_KEY_LENGTH = 24


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One question about two motions."""

    id: str
    """By position, such as t07: tells a participant nothing."""
    position: int
    """Place in the participant's order, from 0."""
    of: int
    """Trials in all, checks included."""
    question: JudgeQuestion
    pair: int | None
    """Place in the pair file; None for an attention check."""
    shown_left: Place
    """Which member stands on the left; of a check, the second is the reference itself."""
    clips: Mapping[str, ClipName]
    """What `left`, `right` and, unless the question is about danger, `reference` show."""
    keys: Mapping[str, str]
    """Their opaque names for the page, which tell neither who is who nor what is a check."""

    def member(self, side: Side) -> Place:
        """Who stands on a side."""
        on_the_right: Place = "second" if self.shown_left == "first" else "first"
        return self.shown_left if side == "left" else on_the_right

    def public(self) -> Mapping[str, Any]:
        """What the page is told: id, position, and a key for each motion."""
        return {"id": self.id, "position": self.position, "of": self.of, **self.keys}


class _Item(NamedTuple):
    """What one trial compares: a pair of the file, or a check."""

    pair: int | None
    members: Mapping[Place, ClipName]
    reference: ClipName


def trials_for(plan: StudyPlan, stage: int, participant: Participant) -> tuple[Trial, ...]:
    """The participant's trials in a questionnaire, in their order.

    Each pair is shown once, with the first member on the left in half of them. The participants of
    places 2k and 2k + 1 among those of the role see every pair with its sides exchanged, so that
    sides balance over participants as well. Checks are spread evenly and never come first.

    Args:
        plan: The study's.
        stage: Place of the questionnaire in the stages of the participant's role.
        participant: Code, role and place matter.

    Raises:
        UserError: The pair file is missing, damaged or does not suit the stage.
    """
    judged = judge_stage(plan, participant.role, stage)
    draw = f"{plan.seed}/{participant.role}/{stage}"
    return _trials(judged, draw, participant.code, participant.place)


def preview_trials(plan: StudyPlan, role: str, stage: int) -> tuple[Trial, ...]:
    """The trials as somebody who is no participant would see them.

    Raises:
        UserError: The pair file is missing, damaged or does not suit the stage.
    """
    return _trials(judge_stage(plan, role, stage), f"{plan.seed}/{role}/{stage}", PREVIEW, None)


def judge_stage(plan: StudyPlan, role: str, stage: int) -> JudgeStage:
    """A questionnaire of a plan.

    Raises:
        UserError: This stage of the role is none.
    """
    stages = plan.roles[role].stages
    found = stages[stage] if 0 <= stage < len(stages) else None
    if not isinstance(found, JudgeStage):
        raise UserError(f"stage {stage} of role {role} is no questionnaire: reload the page")
    return found


def clips_of(asks: Questionnaire) -> set[ClipName]:
    """Every motion that some participant sees."""
    items = [_pair_item(asks, pair) for pair in range(asks.count)]
    items += [_check_item(asks, check) for check in asks.checks]
    shown = {name for item in items for name in item.members.values()}
    return shown | {item.reference for item in items if asks.question != "danger"}


def _trials(stage: JudgeStage, draw: str, code: str, place: int | None) -> tuple[Trial, ...]:
    asks = questionnaire(stage)
    items = _in_order(asks, draw, code)
    couple, exchanged = (code, False) if place is None else (place // 2, place % 2 == 1)
    lefts = _lefts([_label(item) for item in items], f"side/{draw}/{couple}", exchanged)
    return tuple(
        _trial(stage, item, left, position=position, of=len(items), draw=f"{draw}/{code}")
        for position, (item, left) in enumerate(zip(items, lefts, strict=True))
    )


def _trial(
    stage: JudgeStage, item: _Item, left: Place, *, position: int, of: int, draw: str
) -> Trial:
    right: Place = "second" if left == "first" else "first"
    clips = {"left": item.members[left], "right": item.members[right]}
    if stage.question != "danger":  # Nothing there is compared with canonical motion.
        clips["reference"] = item.reference
    name = f"t{position:02d}"
    return Trial(
        id=name,
        position=position,
        of=of,
        question=stage.question,
        pair=item.pair,
        shown_left=left,
        clips=clips,
        keys={role: _hash(f"key/{draw}/{name}/{role}")[:_KEY_LENGTH] for role in clips},
    )


def _in_order(asks: Questionnaire, draw: str, code: str) -> list[_Item]:
    """Pairs in an order of the participant's own, with checks among them."""
    numbers = sorted(range(asks.count), key=lambda pair: _hash(f"order/{draw}/{code}/{pair}"))
    items = [_pair_item(asks, pair) for pair in numbers]
    places = _check_places(asks.count, len(asks.checks), f"checks/{draw}/{code}")
    for place, check in reversed(list(zip(places, asks.checks, strict=True))):
        items.insert(place, _check_item(asks, check))
    return items


def _pair_item(asks: Questionnaire, pair: int) -> _Item:
    members: dict[Place, ClipName] = {
        "first": clip_of(asks, pair, "first"), "second": clip_of(asks, pair, "second"),
    }  # fmt: skip
    return _Item(pair, members, clip_of(asks, pair, "reference"))


def _check_item(asks: Questionnaire, check: Check) -> _Item:
    member = clip_of(asks, check.pair, check.member)
    itself = clip_of(asks, check.pair, "reference")._replace(moment=member.moment)
    members: dict[Place, ClipName] = {"first": member, "second": itself}
    return _Item(None, members, clip_of(asks, check.pair, "reference"))


def _check_places(pairs: int, checks: int, draw: str) -> list[int]:
    """After how many pairs each check comes: one in each of equal stretches, none at once.

    Example:
        >>> [1 <= first <= 5 < second <= 10 for first, second in [_check_places(10, 2, "any")]]
        [True]
    """
    bounds = [number * pairs // checks for number in range(checks + 1)] if checks else []
    return [
        low + 1 + int(_hash(f"{draw}/{number}"), 16) % (high - low)
        for number, (low, high) in enumerate(pairwise(bounds))
    ]


def _lefts(labels: Sequence[str], draw: str, exchanged: bool) -> list[Place]:
    """Who stands on the left of each trial: the first member in half of them."""
    drawn = sorted(labels, key=lambda label: _hash(f"{draw}/{label}"))
    half = set(drawn[: len(drawn) // 2])
    return ["first" if (label in half) != exchanged else "second" for label in labels]


def _label(item: _Item) -> str:
    first, pair = item.members["first"], "pair" if item.pair is not None else "check"
    return f"{pair}/{first.pair}"


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()

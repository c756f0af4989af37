"""What a page answers, checked and turned into records."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from typing import Literal

from rigid.errors import UserError
from rigid.study.judging.questions import HIGHEST, SCALES, SIDES, asked
from rigid.study.judging.trials import Trial, trials_for
from rigid.study.plan import StudyPlan
from rigid.study.records import Answer, Participant, Question

_SAME = 6
"""What a motion must at least get that is compared with itself, of 7. Ours: people avoid the ends
of scales, so that 7 would be too much to ask."""


def read_answer(
    plan: StudyPlan,
    stage: int,
    participant: Participant,
    *,
    trial: object,
    responses: object,
    rt: object,
    answered: str,
) -> tuple[Answer, ...]:
    """The records of one answered trial: one for each scale and member, or one for a choice.

    Args:
        plan: The study's.
        stage: Place of the questionnaire in the stages of the participant's role.
        participant: Who answers.
        trial: Id of the trial, as the page sent it.
        responses: `asked(question)` → `left` or `right`, or whole numbers from 0 to 7; likewise.
        rt: How long it took [s]; likewise.
        answered: UTC, ISO 8601.

    Raises:
        UserError: There is no such trial, or an answer is missing, unknown or out of range.
    """
    trials = trials_for(plan, stage, participant)
    found = next((one for one in trials if one.id == trial), None)
    if found is None:
        raise UserError(f"trial {trial!r:.40} is none of this questionnaire: reload the page")
    took = _seconds(rt)
    values = _checked(found, responses)
    passed = None if found.pair is not None else _passed(found, values)
    return tuple(
        Answer(
            participant=participant.code, stage=stage, trial=found.id, question=question,
            pair=found.pair, shown_left=found.shown_left, position=found.position, of=of,
            response=response, rt=took, passed=passed, answered=answered,
        )
        for (question, of), response in values.items()
    )  # fmt: skip


def remaining(trials: Sequence[Trial], answers: Iterable[Answer]) -> tuple[Trial, ...]:
    """The trials that have no whole answer yet, in their order.

    Args:
        trials: Of one questionnaire and participant.
        answers: Of the same; those of other stages must be left out.
    """
    given: dict[str, set[tuple[str, str]]] = {}
    for answer in answers:
        given.setdefault(answer.trial, set()).add((answer.question, answer.of))
    return tuple(
        trial for trial in trials if len(given.get(trial.id, ())) < len(asked(trial.question))
    )


_About = Literal["first", "second", "both"]
_Values = Mapping[tuple[Question, _About], float]
"""Responses by scale and member, as records keep them."""


def _seconds(rt: object) -> float:
    if isinstance(rt, bool) or not isinstance(rt, int | float) or not 0 <= rt < math.inf:
        raise UserError(f"rt {rt!r:.40} is no time in seconds: send how long the answer took")
    return float(rt)


def _checked(trial: Trial, responses: object) -> _Values:
    """The responses by member."""
    names = asked(trial.question)
    if not isinstance(responses, Mapping) or responses.keys() != set(names):
        raise UserError(f"responses must hold exactly {', '.join(names)}: answer every question")
    if trial.question == "correspondence":
        side = responses[trial.question]
        if side not in SIDES:
            raise UserError(f"correspondence {side!r:.40} is no side: answer left or right")
        return {("correspondence", "both"): float(trial.member(side) == "second")}
    return {
        (scale, trial.member(side)): _rating(f"{scale}-{side}", responses)
        for scale, side in product(SCALES[trial.question], SIDES)
    }


def _rating(name: str, responses: Mapping[str, object]) -> float:
    value = responses[name]
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= HIGHEST:
        raise UserError(f"{name} {value!r:.40} is no whole number from 0 to {HIGHEST}")
    return float(value)


def _passed(trial: Trial, values: _Values) -> bool:
    """Whether the answers to a check are right: the second member is the reference itself.

    Correspondence: it was chosen. Naturalness: it got at least 6, and more than the other one.
    Danger: it reached the goal better, and was not more dangerous.
    """
    if trial.question == "correspondence":
        return values["correspondence", "both"] == 1
    if trial.question == "naturalness":
        itself, other = values["naturalness", "second"], values["naturalness", "first"]
        return itself >= _SAME and itself > other
    return (
        values["goal", "second"] > values["goal", "first"]
        and values["danger", "second"] <= values["danger", "first"]
    )

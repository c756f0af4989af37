"""What a participant's page is told: where they stand and what comes next."""

from __future__ import annotations

from typing import Any, NamedTuple

from rigid.study import judging
from rigid.study.flow import Position, next_position
from rigid.study.plan import JudgeStage, PlayStage, StudyPlan, WatchStage
from rigid.study.records import Participant
from rigid.study.service.demographics import QUESTIONS
from rigid.study.store import Store


class Standpoint(NamedTuple):
    """A participant, and where they stand."""

    participant: Participant
    position: Position


def standpoint(plan: StudyPlan, store: Store, code: str) -> Standpoint:
    """Where somebody stands; notes in the store when they have done everything.

    Raises:
        GoneError: There is no such participant.
    """
    standing = store.standing(code)
    found = next_position(plan, standing)
    if found.kind == "done" and standing.participant.status == "active":
        store.finish(code)
    return Standpoint(standing.participant, found)


def state_of(plan: StudyPlan, store: Store, code: str) -> dict[str, Any]:
    """The state as the page reads it: JSON.

    Raises:
        GoneError: There is no such participant.
    """
    participant, position = standpoint(plan, store, code)
    stages = plan.roles[participant.role].stages
    return {
        **_frame(plan, participant),
        "before": ["consent", *(["demographics"] if plan.demographics else [])],
        "stages": [{"kind": stage.kind, "index": i} for i, stage in enumerate(stages)],
        "stage": _stage(plan, participant, position),
        "can_stop": position.kind not in {"done", "stopped"},
    }


def withdrawn_state(plan: StudyPlan, participant: Participant) -> dict[str, Any]:
    """The last state of somebody who is deleted."""
    stage = {"kind": "withdrawn"}
    return {
        **_frame(plan, participant),
        "before": [],
        "stages": [],
        "stage": stage,
        "can_stop": False,
    }


def _frame(plan: StudyPlan, participant: Participant) -> dict[str, Any]:
    return {
        "title": plan.title,
        "language": plan.language,
        "participant": {"code": participant.code, "role": participant.role},
    }


def _stage(plan: StudyPlan, participant: Participant, position: Position) -> dict[str, Any]:
    if position.kind == "consent":
        consent = plan.consent
        return {
            "kind": "consent", "version": consent.version, "text": consent.text,
            "sharing": consent.sharing, "contact": consent.contact,
        }  # fmt: skip
    if position.kind == "demographics":
        return {"kind": "demographics", "questions": list(QUESTIONS)}
    if position.kind == "done":
        code, url = (plan.completion.code, plan.completion.url) if plan.completion else (None, None)
        return {"kind": "done", "code": code, "url": url}
    if position.kind == "stopped" or position.index is None:
        return {"kind": "stopped"}
    return _stage_of_role(plan, participant, position, position.index)


def _stage_of_role(
    plan: StudyPlan, participant: Participant, position: Position, index: int
) -> dict[str, Any]:
    role = plan.roles[participant.role]
    stage = role.stages[index]
    common = {
        "kind": stage.kind, "index": index, "of": position.of, "done": position.done,
        "instructions": role.instructions.get(stage.kind),
    }  # fmt: skip
    if isinstance(stage, WatchStage):
        episodes = [f"c{number}" for number in range(stage.episodes)]
        seen = [name for name in episodes if name in position.finished]
        return {**common, "episodes": episodes, "seen": len(seen)}
    if isinstance(stage, JudgeStage):
        trials = judging.trials_for(plan, index, participant)
        left = [trial.public() for trial in trials if trial.id not in position.finished]
        return {**common, "question": stage.question, "show": stage.show, "trials": left}
    return {**common, "manner": stage.manner if isinstance(stage, PlayStage) else "as-watched"}

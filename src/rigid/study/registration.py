"""What is fixed before the first participant, as in a preregistration.

Hashes of the study's file, its task, its robots, its pair files and the analysis are stored before
anybody consents. From then on a server that would collect anything else refuses to start.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict

from rigid.data.pair_file import file_hash
from rigid.files import json_text
from rigid.policies.loading import policy_hash
from rigid.policies.protocol import Policy
from rigid.study.analysis.settings import AnalysisSettings, analysis_hash
from rigid.study.plan import JudgeStage, StudyPlan, plan_hash
from rigid.study.store.fixed import STUDY
from rigid.study.store.store import Store
from rigid.tasks.protocol import Task, control_period, feature_units

_TASK = "task_facts"


class TaskFacts(BaseModel):
    """What exports tell of the task; stored, since a newer RIGID may describe it otherwise."""

    model_config = ConfigDict(frozen=True)

    description: Mapping[str, Any]
    """`Task.describe()`."""
    feature_names: tuple[str, ...]
    feature_units: Mapping[str, str]
    control_period: float
    """[s]."""
    horizon: int


def study_hashes(
    plan: StudyPlan,
    *,
    task: Task | None = None,
    robots: Mapping[str, Policy] | None = None,
    analysis: AnalysisSettings | None = None,
) -> dict[str, str]:
    """SHA-256 of all that is fixed, by name.

    Args:
        plan: The study.
        task: What is played.
        robots: Who is met, by their keys in the plan.
        analysis: How it will be analysed; by default as `rigid study analyze` does.

    Returns:
        `study`, `analysis`, `task`, `robots/KEY` and `pairs/NAME`; files of one name in several
        folders count from the second on as `pairs/NAME-2`.

    Raises:
        UserError: A pair file cannot be read.
    """
    found = {STUDY: plan_hash(plan), "analysis": analysis_hash(analysis)}
    if task is not None:
        found["task"] = hashlib.sha256(json_text(task.describe()).encode()).hexdigest()
    found |= {f"robots/{key}": policy_hash(robot) for key, robot in (robots or {}).items()}
    stages = [stage for role in plan.roles.values() for stage in role.stages]
    paths = dict.fromkeys(stage.pairs for stage in stages if isinstance(stage, JudgeStage))
    for path in paths:
        name, again = path.name, 1
        while f"pairs/{name}" in found:
            again += 1
            name = f"{path.name}-{again}"
        found[f"pairs/{name}"] = file_hash(path)
    return found


def register_study(
    store: Store,
    plan: StudyPlan,
    *,
    task: Task | None = None,
    robots: Mapping[str, Policy] | None = None,
    analysis: AnalysisSettings | None = None,
) -> Mapping[str, str]:
    """Registers what is fixed, or makes sure that it is as it was when somebody consented first.

    Args:
        store: Open to write.
        plan: As `study_hashes`; likewise the others.
        task: What is played; its description is kept for exports.
        robots: Who is met.
        analysis: How it will be analysed.

    Returns:
        What is registered.

    Raises:
        UserError: Something has changed; the message names it and the cure.
    """
    hashes = study_hashes(plan, task=task, robots=robots, analysis=analysis)
    store.register(hashes, {} if task is None else {_TASK: _facts(task).model_dump_json()})
    return store.registered()


def task_facts(store: Store, task: Task | None = None) -> TaskFacts | None:
    """What was registered of the task; of `task` itself where nothing was."""
    found = store.fact(_TASK)
    if found is None:
        return None if task is None else _facts(task)
    return TaskFacts.model_validate_json(found)


def _facts(task: Task) -> TaskFacts:
    return TaskFacts(
        description=dict(task.describe()), feature_names=tuple(task.feature_names),
        feature_units=dict(feature_units(task)), control_period=control_period(task),
        horizon=task.horizon,
    )  # fmt: skip

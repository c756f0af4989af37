"""Task and robots of a study, opened."""

from __future__ import annotations

from typing import NamedTuple

from rigid.errors import UserError
from rigid.policies.loading import load_policy
from rigid.policies.opening import Opening
from rigid.policies.protocol import Policy
from rigid.study.plan import StudyPlan
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task


class Players(NamedTuple):
    """Who participants meet, and where."""

    task: Task
    robots: dict[str, Policy]
    """By their keys in the study's file."""


def open_players(plan: StudyPlan, *, trust: bool, opening: Opening | None = None) -> Players:
    """Opens what a study names.

    Args:
        plan: The study's.
        trust: Whether its file may name a task that runs code.
        opening: How its robots are opened; by default likewise.

    Raises:
        UserError: There is no such task or robot, or it runs code and is not trusted.
    """
    if ":" in plan.task and not trust:
        raise UserError(
            f"the study's task {plan.task!r} runs code: say --trust if you trust whoever wrote the "
            "study"
        )
    task = make_task(plan.task)
    opening = opening or Opening(trust=trust, named_by_user=trust)
    robots = {
        key: load_policy(spec, task=task, agent="robot", opening=opening)
        for key, spec in plan.robots.items()
    }
    return Players(task, robots)

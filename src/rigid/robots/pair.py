"""`rigid train co-optimize`: a human and a robot who learn together (paper, appendix B).

A pair's directory holds `human/` (the synthetic human), `robot/` (the expert that sees what is
hidden) and, while it trains, `checkpoint.safetensors`.
"""

from __future__ import annotations

from pathlib import Path

from rigid.errors import UserError
from rigid.learning.cooptimisation import (
    CoOptimisationSettings,
    co_optimise,
    start_team,
)
from rigid.learning.learner import Learner
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.native import CARD_FILE, Agent, save_policy
from rigid.robots.storing import Checkpoint, Report, privileged_view, provenance
from rigid.tasks.protocol import Task


def train_pair(
    task: Task, settings: CoOptimisationSettings, *, seed: int, out: Path, report: Report
) -> None:
    """Co-optimises a pair into `out`; an interrupted training in it goes on.

    Raises:
        UserError: `out` holds a finished pair, something else, or another training.
    """
    if (out / "human" / CARD_FILE).exists():
        raise UserError(f"{out} already holds a finished pair: choose another directory with --out")
    privileged = privileged_view(task)
    made_by = provenance("co-optimize", settings, seed)
    checkpoint = Checkpoint(out, task, made_by)
    start = checkpoint.resume(start_team(privileged, settings, seed))
    report.begin(privileged, settings.episodes, start[1])

    team = co_optimise(
        report.watch(privileged), settings,
        seed=seed, start=start, report=checkpoint.keeping(report),
    )  # fmt: skip
    made: tuple[tuple[Agent, Learner, Task], ...] = (
        ("robot", team.robot, privileged),
        ("human", team.humans[0], task),  # Last: who finds it may rely on both.
    )
    for agent, learner, world in made:
        policy = GaussianPolicy(learner.policy)
        save_policy(policy, out / agent, agent=agent, task=world.describe(), provenance=made_by)
    checkpoint.drop()

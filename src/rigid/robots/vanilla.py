"""`rigid train vanilla`: the paper's Vanilla RL (appendix 'Learning Robot Policies')."""

from __future__ import annotations

from pathlib import Path

from rigid.learning.personalisation import (
    Partner,
    PersonalisationSettings,
    personalise,
    start_robot,
)
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import policy_hash
from rigid.robots.storing import (
    Checkpoint,
    Report,
    one_of_pair,
    privileged_view,
    provenance,
    refuse_finished,
    store_robot,
)
from rigid.tasks.protocol import Task


def train_vanilla(
    task: Task,
    settings: PersonalisationSettings,
    *,
    pair: Path,
    seed: int,
    out: Path,
    canonical_episodes: int,
    report: Report,
) -> None:
    """A robot personalized to the human of `pair`, with canonical data.

    Raises:
        UserError: `pair` is no pair, or `out` holds a finished robot, something else or another
            training.
    """
    refuse_finished(out)
    privileged = privileged_view(task)
    human = one_of_pair(pair, "human", task)
    expert = one_of_pair(pair, "robot", privileged)
    made_by = provenance("vanilla", settings, seed) | {
        "human": policy_hash(human), "expert": policy_hash(expert),
    }  # fmt: skip
    checkpoint = Checkpoint(out, task, made_by)
    start = checkpoint.resume(start_robot(task, privileged, settings, seed))
    report.begin(privileged, settings.episodes, start[1])

    learner = personalise(
        task,
        report.watch(privileged),
        [Partner(human, expert)],
        settings,
        seed=seed,
        start=start,
        report=checkpoint.keeping(report),
    )
    robot = GaussianPolicy(learner.policy, memory=settings.memory)
    store_robot(
        robot, human, task,
        out=out, seed=seed, canonical_episodes=canonical_episodes, made_by=made_by,
    )  # fmt: skip
    checkpoint.drop()

"""`rigid train palm`: a robot that embeds how the human moves (He et al., 2022, and the paper).

The paper, appendix 'Learning Robot Policies': for diverse humans the itch lies anywhere on the two
arms. So a second pair is co-optimised in the task made diverse; it lies in `diverse/`. Departures:
our seated human moves one arm, so the itch lies anywhere along both limbs of that arm; and half of
the episodes are played in the ordinary task with the synthetic human of the given pair, with whom
the robots of all recipes are measured.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.motion import shown_columns
from rigid.learning.palm import (
    Companion,
    PalmSettings,
    Prediction,
    held_out_prediction,
    personalise_palm,
    policy_of,
    start_palm,
)
from rigid.learning.personalisation import Partner
from rigid.policies.loading import policy_hash
from rigid.robots.pair import train_pair
from rigid.robots.storing import (
    Checkpoint,
    Report,
    already_made,
    one_of_pair,
    privileged_view,
    provenance,
    refuse_finished,
    store_robot,
)
from rigid.tasks.protocol import Task, VariesHumans

_DIVERSE = "diverse"


@dataclass(frozen=True, kw_only=True)
class PalmRecipe:
    """Budget of both stages."""

    diverse: CoOptimisationSettings = field(default_factory=CoOptimisationSettings)
    """Of the diverse pair; as for any pair."""
    palm: PalmSettings = field(default_factory=PalmSettings)
    diverse_share: float = 0.5
    """Of the episodes, with the diverse human. Ours, the paper gives none: with a half, success is
    1.00 with the synthetic human of the bundled pair and 0.98 with the diverse one, with three
    quarters 1.00 and 0.99; so nobody is favoured."""
    judged_episodes: int = 100
    """Fresh ones, on which prediction is compared with constant velocity. Ours."""


def train_palm(
    task: Task,
    recipe: PalmRecipe,
    *,
    pair: Path,
    seed: int,
    out: Path,
    canonical_episodes: int,
    report_diverse: Report,
    report: Report,
) -> Prediction:
    """Trains the diverse pair and the robot into `out`; an interrupted training in it goes on.

    Args:
        task: The task as the robot will meet it.
        recipe: Budgets.
        pair: Directory of the pair whose human is the synthetic human.
        seed: Everything random comes from it.
        out: Directory of the robot.
        canonical_episodes: Recorded with the finished robot and the synthetic human.
        report_diverse: Told of the co-optimisation.
        report: Told of the robot's training.

    Returns:
        How well the robot predicts motion that it was not trained on.

    Raises:
        UserError: The task cannot make its humans diverse, `pair` is no pair, or `out` holds a
            finished robot, something else or another training.
    """
    refuse_finished(out)
    shown_columns(task)  # Refuses a task that cannot do it, before any work.
    assert isinstance(task, VariesHumans)
    diverse = task.diversified()
    made_by = provenance("palm", recipe, seed)
    companions = [_companion(pair, task, 1 - recipe.diverse_share)]
    made_by |= _hashes(companions[0])
    checkpoint = Checkpoint(out, task, made_by, beside=(_DIVERSE,))
    _train_diverse(diverse, recipe.diverse, seed=seed, out=out / _DIVERSE, report=report_diverse)
    companions.append(_companion(out / _DIVERSE, diverse, recipe.diverse_share))
    start = checkpoint.resume(start_palm(task, companions[0].task, recipe.palm, seed))
    report.begin(companions[0].task, recipe.palm.personalisation.episodes, start[1])

    learner = personalise_palm(
        task, [one._replace(task=report.watch(one.task)) for one in companions], recipe.palm,
        seed=seed, start=start, report=checkpoint.keeping(report),
    )  # fmt: skip
    partners = [one.partner for one in companions]
    prediction = held_out_prediction(
        [task, diverse], partners, learner, recipe.palm,
        episodes=recipe.judged_episodes, seed=seed,
    )  # fmt: skip
    made_by |= {_DIVERSE: _hashes(companions[1]), "prediction_error": prediction._asdict()}
    store_robot(
        policy_of(learner, recipe.palm), partners[0].human, task,
        out=out, seed=seed, canonical_episodes=canonical_episodes, made_by=made_by,
    )  # fmt: skip
    checkpoint.drop()
    return prediction


def _companion(pair: Path, task: Task, share: float) -> Companion:
    privileged = privileged_view(task)
    human = one_of_pair(pair, "human", task)
    return Companion(Partner(human, one_of_pair(pair, "robot", privileged), share), privileged)


def _hashes(companion: Companion) -> dict[str, str]:
    human, expert = companion.partner.human, companion.partner.expert
    assert expert is not None  # As `_companion` made it.
    return {"human": policy_hash(human), "expert": policy_hash(expert)}


def _train_diverse(
    task: Task, settings: CoOptimisationSettings, *, seed: int, out: Path, report: Report
) -> None:
    """Co-optimises the diverse pair; a finished one of the same making is left as it is."""
    if not already_made(out / "human", task, provenance("co-optimize", settings, seed)):
        train_pair(task, settings, seed=seed, out=out, report=report)

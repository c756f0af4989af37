"""`rigid train robust-gt`: a robot that goes on learning with the humans that broke it.

The paper's Robust GT (appendix 'Learning Robot Policies'): the most harmful adversaries of
naturalness in [0.2, 0.8] take 15 % of the episodes, the synthetic human the others, and training
goes on from the robot that was measured. The name is the paper's; it is no ground truth: what was
found is one search's, and whether robustness grew is for a fresh search to say.

Departures: the measured robot itself is the expert on its own human, so that it unlearns nothing
there, and any finished frontier will do, whoever trained its robot; with adversaries nobody knows
better, and reward alone teaches.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.compute.subject import measured_robot, measured_task
from rigid.errors import UserError
from rigid.frontier.result import Frontier, load_frontier
from rigid.learning.personalisation import (
    Partner,
    PersonalisationSettings,
    continue_robot,
    personalise,
    start_robot,
)
from rigid.learning.ppo import PPOSettings
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.opening import NAMED_BY_FILE, SAFE
from rigid.policies.protocol import Policy
from rigid.robots.storing import (
    Checkpoint,
    Report,
    privileged_view,
    provenance,
    refuse_finished,
    store_robot,
)
from rigid.tasks.protocol import Task


@dataclass(frozen=True, kw_only=True)
class RobustSettings:
    """Which adversaries are trained against, and for how long."""

    naturalness: tuple[float, float] = (0.2, 0.8)
    """Range of the adversaries that are taken (paper)."""
    adversaries: int = 6
    """At most; the paper chooses by hand and gives no number."""
    share: float = 0.15
    """Of the episodes, for all adversaries together (paper)."""
    from_scratch: bool = False
    """Start from a random robot instead of the measured one; the paper mentions both."""
    training: PersonalisationSettings = field(
        default_factory=lambda: PersonalisationSettings(
            iterations=60,
            episodes=192,
            ppo=PPOSettings(
                learning_rate=3e-4, clip=0.3, epochs=6, minibatch=1920, cloning_coefficient=1.0
            ),
        )
    )
    """As for `vanilla`, but with twice the episodes, so that each adversary has some, and reward at
    full weight: it alone teaches there. With the bundled robot and its own human the return is flat
    from the 20th of 60 iterations on. Ours."""


class NoTeachersError(UserError):
    """The search found no adversary in the range of naturalness."""


class Lesson(NamedTuple):
    """What is needed to go on with a measured robot."""

    task: Task
    robot: GaussianPolicy
    human: GaussianPolicy
    """Its synthetic human."""
    adversaries: Sequence[Policy]
    found: Sequence[dict[str, Any]]
    """Where each adversary is from, for the card."""


def choose_adversaries(
    points: Sequence[dict[str, Any]], settings: RobustSettings
) -> list[dict[str, Any]]:
    """The most harmful points in the range of naturalness: of each search seed first, then more.

    Seeds find different ways to break a robot, so one of each is worth more than many of one. Ours.

    Args:
        points: Of `frontier.json`.
        settings: Range and number.

    Example:
        >>> points = [
        ...     {"id": "a", "seed": 0, "naturalness": 0.5, "return": -90.0},
        ...     {"id": "b", "seed": 0, "naturalness": 0.6, "return": -80.0},
        ...     {"id": "c", "seed": 1, "naturalness": 0.7, "return": -10.0},
        ...     {"id": "d", "seed": 1, "naturalness": 0.9, "return": -70.0},
        ... ]
        >>> [p["id"] for p in choose_adversaries(points, RobustSettings(adversaries=2))]
        ['a', 'c']
    """
    low, high = settings.naturalness
    inside = [p for p in points if p["return"] is not None and low <= p["naturalness"] <= high]
    ranked = sorted(inside, key=lambda point: float(point["return"]))
    first: dict[int, str] = {}
    for point in ranked:
        first.setdefault(point["seed"], point["id"])
    leads = set(first.values())
    ranked.sort(key=lambda point: point["id"] not in leads)  # Stable: by harm within both parts.
    return ranked[: settings.adversaries]


def take_lesson(
    runs: Sequence[Path],
    settings: RobustSettings,
    *,
    task: Task | None = None,
    robot: str | None = None,
) -> Lesson:
    """Reads what finished measurements teach; the last of them is the robot that goes on.

    Args:
        runs: Run directories; adversaries are chosen from all of them.
        settings: Which adversaries.
        task: The runs'; by default RIGID's own of that description.
        robot: Where the measured robot is now; by default where it was.

    Raises:
        UserError: A run is not finished or of another task, the robot is another one
            than was measured or none that can go on learning.
        NoTeachersError: No adversary is in the range.
    """
    frontier = load_frontier(runs[-1])
    identity = read_settings(RunDirectory(runs[-1]))["identity"]
    task = measured_task(runs[-1], identity, task)
    measured = measured_robot(
        robot or str(frontier.data["robot"]), task, identity,
        opening=SAFE if robot else NAMED_BY_FILE,
    )  # fmt: skip
    if not isinstance(measured, GaussianPolicy):
        raise UserError(
            f"robot {frontier.data['robot']!r} is a {type(measured).__name__}, which cannot go on "
            "learning here: robust-gt takes robots of `rigid train vanilla`, gleave or robust-gt"
        )
    human = load_policy(
        str(frontier.data["human"]), task=task, agent="human", opening=NAMED_BY_FILE
    )
    assert isinstance(human, GaussianPolicy)  # Nobody else was searched from.
    chosen = [
        (run.directory, point)
        for run in map(load_frontier, runs)
        for point in choose_adversaries(_trained(run), settings)
    ]
    if not chosen:
        low, high = settings.naturalness
        more = (
            "search with more --seeds or --lambdas" if frontier.data["preset"] == "paper"
            else "measure with --preset paper, which finds more of them"
        )  # fmt: skip
        raise NoTeachersError(
            f"{runs[-1]} has no adversary of naturalness in [{low:g}, {high:g}]: {more}, or widen "
            "the range with --naturalness"
        )
    adversaries = [
        load_policy(str(place / "adversaries" / point["id"]), task=task, agent="human")
        for place, point in chosen
    ]
    return Lesson(task, measured, human, adversaries, [_said(*one) for one in chosen])


def train_robust_gt(
    lesson: Lesson,
    settings: RobustSettings,
    *,
    seed: int,
    out: Path,
    canonical_episodes: int,
    report: Report,
    beside: Collection[str] = (),
) -> None:
    """Trains a robot into `out`; an interrupted training in it goes on.

    Args:
        lesson: From `take_lesson`.
        settings: Share and budget.
        seed: Everything random comes from it.
        out: Directory of the robot.
        canonical_episodes: Recorded with the finished robot.
        report: Told of progress.
        beside: Names of what may lie in `out` already.

    Raises:
        UserError: `out` holds a finished robot, something else or another training.
    """
    refuse_finished(out)
    task, privileged = lesson.task, privileged_view(lesson.task)
    training = replace(settings.training, memory=lesson.robot.memory, hidden=_hidden(lesson.robot))
    made_by = making_of(lesson, settings, seed)
    checkpoint = Checkpoint(out, task, made_by, beside=beside)
    fresh = (
        start_robot(task, privileged, training, seed)
        if settings.from_scratch
        else continue_robot(task, privileged, training, lesson.robot, seed)
    )
    start = checkpoint.resume(fresh)
    report.begin(privileged, training.episodes, start[1])

    learner = personalise(
        task, report.watch(privileged), _partners(lesson, settings), training,
        seed=seed, start=start, report=checkpoint.keeping(report),
    )  # fmt: skip
    robot = GaussianPolicy(learner.policy, memory=training.memory)
    store_robot(
        robot, lesson.human, task,
        out=out, seed=seed, canonical_episodes=canonical_episodes, made_by=made_by,
    )  # fmt: skip
    checkpoint.drop()


def making_of(lesson: Lesson, settings: RobustSettings, seed: int) -> dict[str, Any]:
    """The part of a card that says how a robot was made of a lesson."""
    return provenance("robust-gt", settings, seed) | {
        "human": policy_hash(lesson.human), "from": policy_hash(lesson.robot),
        "adversaries": list(lesson.found),
    }  # fmt: skip


def _partners(lesson: Lesson, settings: RobustSettings) -> list[Partner]:
    each = settings.share / len(lesson.adversaries)
    own = Partner(lesson.human, lesson.robot, 1 - settings.share)
    return [own, *(Partner(human, None, each) for human in lesson.adversaries)]


def _trained(frontier: Frontier) -> list[dict[str, Any]]:
    return [point for point in frontier.points if not point["faults"]]


def _said(place: Path, point: dict[str, Any]) -> dict[str, Any]:
    said = {key: point[key] for key in ("id", "naturalness", "adversarialness")}
    human = place / "adversaries" / point["id"]
    return {"run": place.name, **said, "sha256": policy_hash(human)}


def _hidden(robot: GaussianPolicy) -> tuple[int, ...]:
    return tuple(layer["w"].shape[1] for layer in robot.parameters.network[:-1])

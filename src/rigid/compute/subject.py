"""Who is measured: the robot, its human and their canonical episodes, as the user named them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigid.compute.return_range import ReturnRange
from rigid.errors import UserError
from rigid.files import json_text, lies_there
from rigid.naturalness.features import DEFAULT
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import BUNDLED, load_policy, policy_hash
from rigid.policies.native import CARD_FILE, load_card
from rigid.policies.opening import NAMED_BY_FILE, SAFE, Opening
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task
from rigid.tasks.registry import task_from_description

CANONICAL_FILE = "canonical.npz"
SYNTHETIC_HUMAN = "builtin:synthetic-human"
"""Whom a robot meets where nobody is named."""
_FIRST_RULER_SEED = 2**31
"""Beyond what people choose: a robot's own episodes, or those of `rigid record --seed 1`, must not
be the very episodes that the referee judges by. Below 2**32, since NumPy takes [2**32, 0] for the
words 0, 1, 0, which is block 1 of seed 0. Ours."""


@dataclass(frozen=True)
class Subject:
    """Who is measured, with whom, on what; as the user named it."""

    task: Task
    robot: str
    human: str = SYNTHETIC_HUMAN
    canonical: str | None = None
    """A file of canonical episodes; by default the robot's own, or a fresh recording."""
    features: str = DEFAULT
    """What naturalness sees of the human, for search and referee alike; see `choose_features`."""
    opening: Opening = SAFE
    """How files of other libraries are opened."""
    return_range: ReturnRange | None = None
    """The range of adversarialness in place of the task's own; see `find_return_range`."""
    canonical_draw: int = 0
    """Which draw of canonical play this is: the referee's episodes, the deviation of reward and,
    where `canonical` names no file, the search's episodes. Draw 0 is everybody's, and alone takes
    the episodes that lie beside the robot; others show what a wholly new measurement would say."""

    @property
    def search_seed(self) -> int:
        """Of the recording that the search sees, where no file holds its episodes."""
        return self.canonical_draw

    @property
    def ruler_seed(self) -> int:
        """Of the recording that referees see; no recording's seed serves twice, over all draws."""
        return _FIRST_RULER_SEED + self.canonical_draw


def load_robot(subject: Subject) -> Policy:
    """The robot.

    Raises:
        UserError: It does not exist, is damaged or does not fit.
    """
    return load_policy(subject.robot, task=subject.task, agent="robot", opening=subject.opening)


def load_players(subject: Subject) -> tuple[Policy, GaussianPolicy]:
    """The robot, and the synthetic human that the search starts from.

    Raises:
        UserError: One does not exist, is damaged or does not fit; the human is none to search with.
    """
    robot = load_robot(subject)
    human = load_policy(subject.human, task=subject.task, agent="human", opening=subject.opening)
    if not isinstance(human, GaussianPolicy):
        raise UserError(
            f"human {subject.human!r} has no action noise to search with: name a synthetic human, "
            "for example builtin:synthetic-human"
        )
    if human.memory != 1:
        raise UserError(
            f"human {subject.human!r} sees its last {human.memory} observations, but the search "
            "starts from a human without memory: name a synthetic human trained so"
        )
    return robot, human


def stranger(robot: str, human: str, met: Policy, task: Task) -> str | None:
    """Says that a robot meets the bundled human, though it was trained for another one.

    Whoever names a human means that one, so that only a human who was not named is looked at.

    Args:
        robot: As the user named it; other policies than native ones tell nothing.
        human: Likewise.
        met: That human.
        task: Theirs.

    Returns:
        A warning; None where there is nothing to warn of.
    """
    folder = _folder(robot, task)
    there = lies_there(folder / CARD_FILE)
    if human != SYNTHETIC_HUMAN or not there or not isinstance(met, GaussianPolicy):
        return None
    known = load_card(folder).provenance.get("human")
    if known is None or known == policy_hash(met):
        return None
    return (
        f"warning: {robot} was trained for another human than {human}, who was taken since none is "
        "named: name its own with --human, or everything tells how it copes with a stranger"
    )


def measured_robot(
    spec: str,
    task: Task,
    identity: Mapping[str, Any],
    *,
    cure: str = "name it with --robot",
    opening: Opening = NAMED_BY_FILE,
) -> Policy:
    """The robot of a finished run, from where it is now.

    Args:
        spec: As a user names it.
        task: The run's.
        identity: Of the run's settings.
        cure: What to do about another robot; ends the message.
        opening: How its file is opened; by default as that of a robot which the run names.

    Raises:
        UserError: There is no robot, or it is not the one that was measured.
    """
    robot = load_policy(spec, task=task, agent="robot", opening=opening)
    if policy_hash(robot) != identity.get("robot"):
        raise UserError(f"robot {spec!r} is not the one that was measured: {cure}")
    return robot


def canonical_path(subject: Subject) -> Path | None:
    """The user's file, else the episodes that lie beside the robot, if there are any."""
    if subject.canonical is not None:
        return Path(subject.canonical)
    if subject.canonical_draw:
        return None
    file = _folder(subject.robot, subject.task) / CANONICAL_FILE
    return file if lies_there(file) else None


def _folder(robot: str, task: Task) -> Path:
    """Where a native policy would lie that is called so."""
    name = robot.removeprefix("builtin:")
    return Path(str(BUNDLED / task.name / name)) if name != robot else Path(name)


def measured_task(directory: Path, identity: Mapping[str, Any], named: Task | None = None) -> Task:
    """The task that a run was measured on; nothing that the run's files name is ever imported.

    Args:
        directory: For messages.
        identity: Of the run's settings.
        named: The task that the user named, if any.

    Raises:
        UserError: The user has to name it, or named another one.
    """
    task = task_from_description(identity["task"]) if named is None else named
    if task is None:
        raise UserError(
            f"{directory} was measured on a task that is not RIGID's own, and what a file names is "
            "not opened: name it with --task (and --human-agent, --horizon), as it was measured"
        )
    if json_text(task.describe()) != json_text(identity["task"]):
        measured = identity["task"].get("name")
        raise UserError(
            f"{directory} was measured on {measured!r} with other parameters or another version "
            f"than the task {task.name!r} that was named: name it as it was measured"
        )
    return task

"""Success with unseen humans: robots of finished runs play with humans that they were not made for.

A robot learns with its own synthetic human, and is measured with those that a search grew from it.
Whether it also helps somebody else is asked here (ours; the paper's success is with its own).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from rigid.compute.evaluation import evaluate
from rigid.compute.subject import measured_robot
from rigid.errors import UserError
from rigid.frontier.result import Frontier
from rigid.frontier.standings import Measured
from rigid.frontier.successes import Played
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Task
from rigid.tasks.registry import task_from_description

UNSEEN_SEED = 2**20
"""Of the episodes of every pair; no training or recording has it. Ours."""


class Pair(NamedTuple):
    """A robot and a human that it was not made for."""

    run: int
    """Which of the runs measured the robot."""
    robot: Policy
    human: Policy


Track = Callable[[Sequence[Pair]], Iterable[Pair]]
"""Goes through pairs, and may show how far it is."""


def play_unseen(
    runs: Sequence[Measured],
    humans: Sequence[str],
    *,
    episodes: int,
    track: Track = lambda pairs: pairs,
) -> list[Played]:
    """Every robot with every human but its own, in fresh episodes.

    Args:
        runs: Finished measurements of one task.
        humans: As `--human` takes them; the human that a run was made with is left out there.
        episodes: Of each pair.
        track: Shows progress.

    Returns:
        What was achieved, `robot` being the run's place in `runs`. A run with none but its own
        human is not in it.

    Raises:
        UserError: The task is not RIGID's own or knows no success, a robot is not where it was when
            it was measured, or a human does not exist, is named twice or is everybody's own.
    """
    task = _task_of(runs[0])
    others = _load_humans(humans, task)
    pairs = []
    for number, (frontier, identity) in enumerate(runs):
        robot = _robot_of(frontier, identity, task)
        strangers = [human for sha, human in others.items() if sha != identity.get("human")]
        pairs += [Pair(number, robot, human) for human in strangers]
    if not pairs:
        raise UserError(
            "--humans names nobody but the robots' own synthetic human: name those of other pairs"
        )
    return [_play(pair, task, episodes) for pair in track(pairs)]


def _play(pair: Pair, task: Task, episodes: int) -> Played:
    found = evaluate(task, pair.robot, pair.human, episodes=episodes, seed=UNSEEN_SEED)
    if found["success"] is None:
        raise UserError(
            f"success on {task.name!r} is unknown (the task defines none, or every episode "
            "faulted): leave out --humans"
        )
    return Played(pair.run, found["success"], found["episodes"] - found["faults"])


def _task_of(run: Measured) -> Task:
    frontier, identity = run
    described = identity.get("task")
    task = task_from_description(described) if isinstance(described, Mapping) else None
    if task is None:
        raise UserError(
            f"{frontier.directory} was measured on a task that is not RIGID's own, and nothing "
            "that a run names is imported: leave out --humans"
        )
    return task


def _load_humans(specs: Sequence[str], task: Task) -> dict[str, Policy]:
    """Humans by their hash; by what the user wrote where they have none."""
    found: dict[str, Policy] = {}
    named: dict[str, str] = {}
    for spec in specs:
        human = load_policy(spec, task=task, agent="human")
        try:
            key = policy_hash(human)
        except TypeError:  # No weights: nobody's synthetic human.
            key = spec
        if key in found:
            raise UserError(
                f"--humans {named[key]!r} and {spec!r} are the same human: name it once"
            )
        found[key], named[key] = human, spec
    return found


def _robot_of(frontier: Frontier, identity: Mapping[str, Any], task: Task) -> Policy:
    """The robot that was measured; a run's words are never taken for a command."""
    spec = str(frontier.data["robot"])
    if re.match(r"(?!builtin:)\w+:", spec):
        raise UserError(
            f"{frontier.directory}: its robot {spec!r} would run code that the run names: leave "
            "out --humans, and play it with `rigid evaluate` if you trust it"
        )
    try:
        return measured_robot(spec, task, identity, cure="put it back")
    except UserError as error:
        raise UserError(
            f"{frontier.directory}: {error}; --humans needs the robot where it was measured"
        ) from None

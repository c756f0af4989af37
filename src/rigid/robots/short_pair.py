"""A pair in a minute or two, for looking at a new task; never for measuring a robot."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path

import numpy as np

from rigid.errors import UserError
from rigid.files import json_text
from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.personalisation import PersonalisationSettings
from rigid.learning.rollout import play
from rigid.policies.native import CARD_FILE, load_card
from rigid.robots.fitting import fitted
from rigid.robots.pair import train_pair
from rigid.robots.storing import Report, privileged_view
from rigid.robots.vanilla import train_vanilla
from rigid.tasks.protocol import Task

Showing = Callable[[str, int], AbstractContextManager[Report]]
"""Shows the progress of a training of so many iterations."""

_PAIR = CoOptimisationSettings(iterations=60, episodes=48, hidden=(64, 64))
_ROBOT = PersonalisationSettings(iterations=15, episodes=48, hidden=(64, 64))
_EPISODES = 40
"""Canonical ones (paper, 'Collecting Canonical Datasets')."""
_UNIT = 0.03
"""Deviation of a step's reward under random play, as learners see it; that of itch scratching in
`rigid train co-optimize`. Ours."""


def train_short_pair(task: Task, out: Path, *, showing: Showing) -> tuple[str, str]:
    """A robot and its human, in `out`/robot and `out`/pair; an interrupted training goes on.

    Where the task hides nothing from the robot, the pair's own robot serves.

    Args:
        task: Any task.
        out: Where they are kept.
        showing: Shows progress.

    Returns:
        Robot and human, as `load_policy` takes them.

    Raises:
        UserError: `out` holds other trainings, or a finished pair or robot of another task.
    """
    pair, robot = out / "pair", out / "robot"
    for policy in (pair / "human", robot):
        _check_made_in(task, policy)
    scale = _reward_scale(task)
    if not (pair / "human" / CARD_FILE).exists():
        settings = fitted(replace(_PAIR, reward_scale=scale), task.horizon)
        with showing("co-optimising", settings.iterations) as report:
            train_pair(task, settings, seed=0, out=pair, report=report)
    if privileged_view(task) is task:
        return str(pair / "robot"), str(pair / "human")
    if not (robot / CARD_FILE).exists():
        personal = fitted(replace(_ROBOT, reward_scale=scale), task.horizon)
        with showing("robot", personal.iterations) as report:
            train_vanilla(
                task, personal, pair=pair, seed=0, out=robot, canonical_episodes=_EPISODES,
                report=report,
            )  # fmt: skip
    return str(robot), str(pair / "human")


def _check_made_in(task: Task, policy: Path) -> None:
    """Refuses a finished policy of another task, or of another version of this one."""
    if not (policy / CARD_FILE).exists():
        return
    theirs = load_card(policy).task
    if json_text(dict(theirs)) != json_text(dict(task.describe())):
        raise UserError(
            f"{policy} was trained in another task, or before this one was changed "
            f"({theirs.get('name')!r}, now {task.name!r}): choose another directory with --out"
        )


def _reward_scale(task: Task) -> float:
    """What to multiply rewards with, whatever unit the task counts them in."""
    rng = np.random.default_rng(0)
    worlds = fitted(_PAIR, task.horizon).episodes
    played = play(
        task, task.make_world(worlds), rng.integers(2**31, size=worlds),
        lambda _: rng.uniform(-1.0, 1.0, (worlds, task.robot.action_size)),
        lambda _: rng.uniform(-1.0, 1.0, (worlds, task.human.action_size)),
    )  # fmt: skip
    return _UNIT / (float(played.reward.std()) or 1.0)

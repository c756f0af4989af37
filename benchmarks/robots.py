"""Robots that studies train as `rigid train vanilla` does, for the bundled synthetic human."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any

from rigid.commands.train.progress import show_progress
from rigid.errors import UserError
from rigid.files import first_difference
from rigid.learning.personalisation import PersonalisationSettings
from rigid.policies.loading import BUNDLED
from rigid.policies.native import CARD_FILE, load_card
from rigid.robots.vanilla import train_vanilla
from rigid.tasks.protocol import Task

TASK = "itch-scratching"
OWN_HUMAN = "builtin:synthetic-human"
"""Whom every robot is trained for and every frontier is searched from: one ruler for all."""
EXPERT = "builtin:co-optimised"
RECIPE = PersonalisationSettings()
QUICK_RECIPE = replace(RECIPE, episodes=8, ppo=replace(RECIPE.ppo, minibatch=400))
"""The whole road with a budget that says nothing."""


@dataclass(frozen=True, kw_only=True)
class RobotPlan:
    """How one robot is trained; all that is not said here is the recipe's."""

    iterations: int
    seed: int
    std: tuple[float, float] = RECIPE.std
    """Action noise at the start and at the end of training."""

    @property
    def name(self) -> str:
        """Its directory.

        Example:
            >>> RobotPlan(iterations=6, seed=1).name
            'i006-s1'
            >>> RobotPlan(iterations=50, seed=9, std=(0.5, 0.2)).name
            'i050-s9-n0.5-0.2'
        """
        noise = "" if self.std == RECIPE.std else f"-n{self.std[0]:g}-{self.std[1]:g}"
        return f"i{self.iterations:03d}-s{self.seed}{noise}"

    def settings(self, recipe: PersonalisationSettings) -> PersonalisationSettings:
        """Those of its training."""
        return replace(recipe, iterations=self.iterations, std=self.std)


def make_robot(
    robot: RobotPlan,
    recipe: PersonalisationSettings,
    *,
    task: Task,
    out: Path,
    pair: Path,
    canonical_episodes: int,
) -> None:
    """Trains a robot for its own human, or goes on with it; a finished one is only checked.

    Args:
        robot: Its length, seed and noise.
        recipe: All else of its training.
        task: Where it is trained.
        out: Its directory.
        pair: Where its human and the expert are laid side by side, as the training takes them.
        canonical_episodes: Recorded with the finished robot, for searches to see.

    Raises:
        UserError: `out` holds something else, or a robot that was made otherwise.
    """
    settings = robot.settings(recipe)
    if (out / CARD_FILE).exists():
        check_made(out, task, settings, robot.seed)
        return
    _lay_out_pair(pair)
    with show_progress(f"robot {robot.name}", settings.iterations) as report:
        train_vanilla(
            task, settings, pair=pair, seed=robot.seed, out=out,
            canonical_episodes=canonical_episodes, report=report,
        )  # fmt: skip


def check_made(directory: Path, task: Task, settings: Any, seed: int) -> None:
    """Refuses a policy that was made otherwise than the plan says.

    Args:
        directory: A finished native policy.
        task: What it has to have been trained in.
        settings: The dataclass of its recipe.
        seed: Of its training.

    Raises:
        UserError: The message names the first difference.
    """
    card = load_card(directory)
    mine = {"task": dict(task.describe()), "settings": asdict(settings), "seed": seed}
    theirs = {"task": card.task, **card.provenance}
    refuse_other(directory, mine, theirs)


def refuse_other(place: Path, mine: Mapping[str, Any], theirs: Mapping[str, Any]) -> None:
    """Refuses what is kept of another plan.

    Args:
        place: Where it is kept.
        mine: What the study asks for, as JSON.
        theirs: What it was made with; only entries that both have count.

    Raises:
        UserError: The message names the first difference.
    """
    different = first_difference(mine, theirs)
    if different is not None:
        name, wanted, found = different
        raise UserError(
            f"{place} was made with {name} {found}, but the study asks for {wanted}: "
            "delete it, or choose another place with --out"
        )


def _lay_out_pair(place: Path) -> None:
    """The own human and the expert side by side."""
    for spec, agent in ((EXPERT, "robot"), (OWN_HUMAN, "human")):
        bundled = BUNDLED / TASK / spec.removeprefix("builtin:")
        with resources.as_file(bundled) as source:
            shutil.copytree(source, place / agent, dirs_exist_ok=True)

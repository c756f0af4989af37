"""`make bundled`: retrains every policy and data set that ships with RIGID, from recorded seeds.

`python -m rigid.robots.bundled feeding` retrains those of one task.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from rigid.commands.train.progress import show_progress
from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.personalisation import PersonalisationSettings
from rigid.presets import PRESETS
from rigid.robots.pair import train_pair
from rigid.robots.vanilla import train_vanilla
from rigid.tasks.itch_scratching import posture
from rigid.tasks.registry import make_task

SEED = 0
"""Of each bundled pair and robot."""
TASKS = ("itch-scratching", "feeding", "bed-bathing")
"""Whose policies ship with RIGID, by the same recipes and settings."""


def main(tasks: Sequence[str]) -> None:
    """Retrains the policies of some tasks; of all where none is named."""
    for name in tasks or TASKS:
        retrain(name)


def retrain(name: str) -> None:
    """Trains a task's pair and robot in a scratch directory, then replaces the bundled ones."""
    task = make_task(name)
    home = Path(__file__).resolve().parents[1] / "bundled" / task.name
    with tempfile.TemporaryDirectory() as scratch:
        pair, robot = Path(scratch) / "pair", Path(scratch) / "vanilla"
        co_optimisation, personalisation = CoOptimisationSettings(), PersonalisationSettings()
        with show_progress(f"{name} pair", co_optimisation.iterations) as report:
            train_pair(task, co_optimisation, seed=SEED, out=pair, report=report)
        with show_progress(f"{name} vanilla", personalisation.iterations) as report:
            train_vanilla(
                task, personalisation, pair=pair, seed=SEED, out=robot,
                canonical_episodes=PRESETS["standard"].search_canonical, report=report,
            )  # fmt: skip
        for source, part in (
            (pair / "human", "synthetic-human"),
            (pair / "robot", "co-optimised"),
            (robot, "vanilla"),
        ):  # fmt: skip
            shutil.rmtree(home / part, ignore_errors=True)
            shutil.copytree(source, home / part)
    if name == "itch-scratching":
        posture.rewrite()


if __name__ == "__main__":
    main(sys.argv[1:])

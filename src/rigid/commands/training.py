"""`rigid train`: making humans and robots."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.parsing import at_least

if TYPE_CHECKING:
    from rigid.learning.cooptimisation import Progress

_count = tyro.conf.arg(metavar="INT")


@dataclass(frozen=True, kw_only=True)
class CoOptimizeCommand:
    """Train a human and a robot together; the human becomes the synthetic human.

    Example:
      rigid train co-optimize --seed 1 --out runs/pair-1
    """

    out: Path
    """Directory for human/ and robot/; an interrupted training in it goes on."""
    task: str = "itch-scratching"
    """Registered task."""
    seed: int = 0
    """Everything random comes from it."""
    iterations: Annotated[int | None, _count] = None
    """Iterations of 19,200 steps; by default the recipe's."""

    def run(self) -> int:
        """Trains the pair."""
        from rigid.learning.cooptimisation import CoOptimisationSettings
        from rigid.robots.recipes import train_pair
        from rigid.tasks.registry import make_task

        at_least("--seed", self.seed, 0)
        settings = CoOptimisationSettings()
        if self.iterations is not None:
            at_least("--iterations", self.iterations, 1)
            settings = CoOptimisationSettings(iterations=self.iterations)
        with show_progress("co-optimising", settings.iterations) as report:
            train_pair(make_task(self.task), settings, seed=self.seed, out=self.out, report=report)
        print(f"human: {self.out / 'human'}\nrobot: {self.out / 'robot'}")
        return 0


@dataclass(frozen=True, kw_only=True)
class VanillaCommand:
    """Train a robot for one synthetic human (the paper's Vanilla RL), with its canonical data.

    Example:
      rigid train vanilla --pair runs/pair-1 --seed 1 --out runs/robot-1
    """

    pair: Path
    """Directory of `rigid train co-optimize`."""
    out: Path
    """Directory for the robot; an interrupted training in it goes on."""
    task: str = "itch-scratching"
    """Registered task."""
    seed: int = 0
    """Everything random comes from it."""
    iterations: Annotated[int | None, _count] = None
    """Iterations of 9,600 steps; by default the recipe's."""
    memory: int = 1
    """Observations that the robot sees at a time, newest first."""
    episodes: int = 40
    """Canonical episodes to record with the robot."""

    def run(self) -> int:
        """Trains the robot."""
        from dataclasses import replace

        from rigid.learning.personalisation import PersonalisationSettings
        from rigid.robots.recipes import train_vanilla
        from rigid.tasks.registry import make_task

        at_least("--seed", self.seed, 0)
        at_least("--memory", self.memory, 1)
        at_least("--episodes", self.episodes, 1)
        settings = replace(PersonalisationSettings(), memory=self.memory)
        if self.iterations is not None:
            at_least("--iterations", self.iterations, 1)
            settings = replace(settings, iterations=self.iterations)
        with show_progress("personalising", settings.iterations) as report:
            train_vanilla(
                make_task(self.task), settings, pair=self.pair, seed=self.seed, out=self.out,
                canonical_episodes=self.episodes, report=report,
            )  # fmt: skip
        print(f"robot: {self.out}")
        return 0


@dataclass(frozen=True)
class TrainCommand:
    """Make humans and robots."""

    recipe: (
        Annotated[
            CoOptimizeCommand,
            tyro.conf.subcommand("co-optimize", description=inspect.getdoc(CoOptimizeCommand)),
        ]
        | Annotated[
            VanillaCommand,
            tyro.conf.subcommand("vanilla", description=inspect.getdoc(VanillaCommand)),
        ]
    )
    """What to train."""

    def run(self) -> int:
        """Runs the chosen recipe."""
        return self.recipe.run()


@contextmanager
def show_progress(what: str, iterations: int) -> Iterator[Callable[[Progress], None]]:
    """A progress bar over iterations with the newest return and success."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import (
        Progress as Bar,
    )

    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(),
        TextColumn("left"), TimeRemainingColumn(),
    )  # fmt: skip
    console = Console(stderr=True)
    with Bar(*columns, console=console) as bar:
        task = bar.add_task(what, total=iterations)

        def report(progress: Progress) -> None:
            seen = f"return {progress.mean_return:.1f} · success {progress.success:.2f}"
            done = progress.iteration + 1
            bar.update(task, completed=done, description=f"{what} · {seen}")
            if not console.is_terminal and done % 10 == 0:  # A bar does not show in a log.
                console.print(f"{what} {done}/{iterations} · {seen}", highlight=False)

        yield report

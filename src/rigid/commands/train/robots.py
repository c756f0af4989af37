"""`rigid train co-optimize`, `vanilla` and `gleave`: a pair, and robots for its human."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from rigid.commands.naming import TaskOptions
from rigid.commands.parsing import at_least
from rigid.commands.terminal.stopping import goes_on
from rigid.commands.train.progress import show_progress, show_stages

_count = tyro.conf.arg(metavar="INT")


@dataclass(frozen=True, kw_only=True)
class CoOptimizeCommand(TaskOptions):
    """Train a human and a robot together; the human becomes the synthetic human.

    Example:
      rigid train co-optimize --seed 1 --out runs/pair-1
    """

    out: Path
    """Directory for human/ and robot/; an interrupted training in it goes on."""
    seed: int = 0
    """Everything random comes from it."""
    iterations: Annotated[int | None, _count] = None
    """Iterations of 192 episodes, or of 19,200 steps where episodes are longer than 100; by default
    160."""

    def run(self) -> int:
        """Trains the pair."""
        from rigid.learning.cooptimisation import CoOptimisationSettings
        from rigid.robots.fitting import fitted
        from rigid.robots.pair import train_pair

        at_least("--seed", self.seed, 0)
        settings, task = CoOptimisationSettings(), self.open_task()
        if self.iterations is not None:
            at_least("--iterations", self.iterations, 1)
            settings = CoOptimisationSettings(iterations=self.iterations)
        settings = fitted(settings, task.horizon)
        with goes_on(self.out), show_progress("co-optimising", settings.iterations) as report:
            train_pair(task, settings, seed=self.seed, out=self.out, report=report)
        print(f"human: {self.out / 'human'}\nrobot: {self.out / 'robot'}")
        return 0


@dataclass(frozen=True, kw_only=True)
class RobotOptions(TaskOptions):
    """What every recipe needs that starts from a pair."""

    pair: Path
    """Directory of `rigid train co-optimize`."""
    out: Path
    """Directory for the robot; an interrupted training in it goes on."""
    seed: int = 0
    """Everything random comes from it."""
    iterations: Annotated[int | None, _count] = None
    """Iterations of 9,600 steps of the robot's training; by default 100."""
    episodes: int = 40
    """Canonical episodes to record with the robot."""

    def check(self) -> None:
        """Refuses numbers that make no training."""
        at_least("--seed", self.seed, 0)
        at_least("--episodes", self.episodes, 1)
        if self.iterations is not None:
            at_least("--iterations", self.iterations, 1)


@dataclass(frozen=True, kw_only=True)
class VanillaCommand(RobotOptions):
    """Train a robot for one synthetic human (the paper's Vanilla RL), with its canonical data.

    The paper calls it personalized: it learns with the finished human of the pair, from reward and
    from the pair's own robot.

    Example:
      rigid train vanilla --pair runs/pair-1 --seed 1 --out runs/robot-1
    """

    memory: int = 1
    """Observations that the robot sees at a time, newest first."""

    def run(self) -> int:
        """Trains the robot."""
        from dataclasses import replace

        from rigid.learning.personalisation import PersonalisationSettings
        from rigid.robots.fitting import fitted
        from rigid.robots.vanilla import train_vanilla

        self.check()
        at_least("--memory", self.memory, 1)
        task = self.open_task()
        settings = fitted(replace(PersonalisationSettings(), memory=self.memory), task.horizon)
        if self.iterations is not None:
            settings = replace(settings, iterations=self.iterations)
        with goes_on(self.out), show_progress("vanilla", settings.iterations) as report:
            train_vanilla(
                task, settings, pair=self.pair, seed=self.seed, out=self.out,
                canonical_episodes=self.episodes, report=report,
            )  # fmt: skip
        print(f"robot: {self.out}")
        return 0


@dataclass(frozen=True, kw_only=True)
class GleaveCommand(RobotOptions):
    """Train a robot for a population of humans (Czempin & Gleave).

    One robot is co-optimised with three humans of different seeds, of whom the first is the pair's,
    then a robot is personalized to all three.

    Example:
      rigid train gleave --pair runs/pair-1 --seed 1 --out runs/gleave-1
    """

    population_iterations: Annotated[int | None, _count] = None
    """Iterations of 19,200 steps of the co-optimisation; by default 160."""

    def run(self) -> int:
        """Trains population and robot."""
        from dataclasses import replace

        from rigid.robots.fitting import fitted
        from rigid.robots.gleave import GleaveSettings, train_gleave

        self.check()
        task = self.open_task()
        settings = GleaveSettings()
        personalisation, population = settings.personalisation, settings.population
        if self.iterations is not None:
            personalisation = replace(personalisation, iterations=self.iterations)
        if self.population_iterations is not None:
            at_least("--population-iterations", self.population_iterations, 1)
            population = replace(population, iterations=self.population_iterations)
        settings = replace(
            settings,
            personalisation=fitted(personalisation, task.horizon),
            population=fitted(population, task.horizon),
        )
        with (
            goes_on(self.out),
            show_stages(
                ("population", population.iterations),
                ("gleave", personalisation.iterations),
            ) as (of_population, report),
        ):
            train_gleave(
                task, settings, pair=self.pair, seed=self.seed, out=self.out,
                canonical_episodes=self.episodes, report_population=of_population, report=report,
            )  # fmt: skip
        print(f"robot: {self.out}")
        return 0

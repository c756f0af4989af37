"""Pairs and robots of every recipe, made once and kept."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Literal

from benchmarks.kept import has_policy, keep_policy
from benchmarks.paper.places import Places
from benchmarks.paper.plan import Plan
from rigid.commands.terminal.progress import TerminalListener
from rigid.commands.train.progress import show_progress, show_stages
from rigid.compute.subject import CANONICAL_FILE
from rigid.data.episodes import save_episodes
from rigid.data.recording import record
from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.personalisation import PersonalisationSettings
from rigid.policies.loading import BUNDLED, load_policy, policy_hash
from rigid.robots import bundled
from rigid.robots.gleave import train_gleave
from rigid.robots.pair import train_pair
from rigid.robots.palm import train_palm
from rigid.robots.robust_gt import RobustSettings
from rigid.robots.rounds import train_in_rounds
from rigid.robots.vanilla import train_vanilla
from rigid.tasks.protocol import Task

SCOUT = "scout"
"""The frontier of `vanilla` that Robust GT learns from."""
SCRATCH, TWICE = "robust-gt-scratch", "robust-gt-2"
"""Variants: from scratch, and in two rounds."""


class Making:
    """Makes what is missing; what is kept is laid out again where it is needed."""

    def __init__(
        self, plan: Plan, places: Places, task: Task, scout: Callable[[int], Path]
    ) -> None:
        """Takes what it works with.

        Args:
            plan: Budgets.
            places: Where things lie.
            task: What robots are trained for.
            scout: Measures the `vanilla` robot of a seed for Robust GT; returns the run directory.
        """
        self._plan, self._places, self._task, self._scout = plan, places, task, scout

    def has_pair(self, seed: int) -> bool:
        """Whether the pair of a seed is kept."""
        return has_policy(self._places.kept_policy("human", seed))

    def has_robot(self, name: str, seed: int) -> bool:
        """Whether a robot is kept."""
        return has_policy(self._places.kept_policy(name, seed))

    def pair(self, seed: int) -> Path:
        """The pair of a seed, laid out."""
        place, settings = self._places.pair(seed), self._plan.budgets.pair
        agents: tuple[Literal["robot", "human"], ...] = ("robot", "human")
        if self.has_pair(seed) and not has_policy(place / "human"):
            shutil.rmtree(place, ignore_errors=True)
            for agent in agents:
                keep_policy(self._places.kept_policy(_kept(agent), seed), place / agent)
        if self._is_bundled(seed) and not has_policy(place / "human"):
            for agent, name in (("robot", "co-optimised"), ("human", "synthetic-human")):
                _lay_out_bundled(name, place / agent)
        if not has_policy(place / "human"):
            with show_progress(f"pair {seed}", settings.iterations) as report:
                train_pair(self._task, settings, seed=seed, out=place, report=report)
        for agent in agents:
            keep_policy(place / agent, self._places.kept_policy(_kept(agent), seed))
        return place

    def robot(self, name: str, seed: int) -> Path:
        """A robot with its canonical episodes, laid out."""
        place, kept = self._places.robot(name, seed), self._places.kept_policy(name, seed)
        if has_policy(kept) and not has_policy(place):
            shutil.rmtree(place, ignore_errors=True)
            self._record(kept, seed, place)
            keep_policy(kept, place)
        if name == "vanilla" and self._is_bundled(seed) and not has_policy(place):
            _lay_out_bundled(name, place)
        if not has_policy(place):
            self._train(name, seed, place)
        for human in sorted(place.glob("*/human*")):  # Of a population.
            keep_policy(human, self._places.kept_policy(f"{name}-{human.name}", seed))
        keep_policy(place, kept)
        return place

    def _is_bundled(self, seed: int) -> bool:
        """Whether `make bundled` made the pair and the vanilla robot of a seed as this would."""
        budgets = self._plan.budgets
        usual = (CoOptimisationSettings(), PersonalisationSettings())
        return seed == bundled.SEED and (budgets.pair, budgets.vanilla) == usual

    def _record(self, policy: Path, seed: int, place: Path) -> None:
        """As its recipe recorded them."""
        human = load_policy(str(self.pair(seed) / "human"), task=self._task, agent="human")
        robot = load_policy(str(policy), task=self._task, agent="robot")
        hashes = {"robot": policy_hash(robot), "human": policy_hash(human)}
        episodes = record(
            self._task, robot, human, episodes=self._plan.canonical_episodes, seed=seed,
            provenance=hashes,
        )  # fmt: skip
        save_episodes(place / CANONICAL_FILE, episodes)

    def _train(self, name: str, seed: int, place: Path) -> None:
        if name == "vanilla":
            settings = self._plan.budgets.vanilla
            with show_progress(f"{name} {seed}", settings.iterations) as report:
                train_vanilla(
                    self._task, settings, pair=self.pair(seed), seed=seed, out=place,
                    canonical_episodes=self._plan.canonical_episodes, report=report,
                )  # fmt: skip
        elif name == "gleave":
            self._train_gleave(seed, place)
        elif name == "palm":
            self._train_palm(seed, place)
        else:
            self._train_robust(name, seed, place)

    def _train_gleave(self, seed: int, place: Path) -> None:
        settings = self._plan.budgets.gleave
        with (
            show_stages(
                (f"population {seed}", settings.population.iterations),
                (f"gleave {seed}", settings.personalisation.iterations),
            ) as (of_population, report),
        ):
            train_gleave(
                self._task, settings, pair=self.pair(seed), seed=seed, out=place,
                canonical_episodes=self._plan.canonical_episodes,
                report_population=of_population, report=report,
            )  # fmt: skip

    def _train_palm(self, seed: int, place: Path) -> None:
        recipe = self._plan.budgets.palm
        with (
            show_stages(
                (f"diverse pair {seed}", recipe.diverse.iterations),
                (f"palm {seed}", recipe.palm.personalisation.iterations),
            ) as (report_diverse, report),
        ):
            train_palm(
                self._task, recipe, pair=self.pair(seed), seed=seed, out=place,
                canonical_episodes=self._plan.canonical_episodes,
                report_diverse=report_diverse, report=report,
            )  # fmt: skip

    def _train_robust(self, name: str, seed: int, place: Path) -> None:
        settings: RobustSettings = self._plan.budgets.robust
        run = self._scout(seed)
        train_in_rounds(
            run, replace(settings, from_scratch=name == SCRATCH), self._plan.preset,
            rounds=2 if name == TWICE else 1, seed=seed, out=place,
            canonical_episodes=self._plan.canonical_episodes, robot=None,
            training=lambda part: show_progress(
                f"{name} {seed}, {part}", settings.training.iterations
            ),
            searching=lambda part: TerminalListener(f"{name} {seed}, {part}"),
        )  # fmt: skip


def _kept(agent: Literal["robot", "human"]) -> str:
    """Under which name a policy of a pair is kept."""
    return "human" if agent == "human" else "expert"


def _lay_out_bundled(name: str, place: Path) -> None:
    with resources.as_file(BUNDLED / "itch-scratching" / name) as source:
        shutil.copytree(source, place, dirs_exist_ok=True)

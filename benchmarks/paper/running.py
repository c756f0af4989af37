"""The experiments as a list of jobs, the most telling first; what is done is never done again."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.paper.making import SCRATCH, TWICE
from benchmarks.paper.measuring import THOROUGH, Measuring, body_run
from benchmarks.paper.places import Places
from benchmarks.paper.plan import RECIPES, Plan
from benchmarks.paper.writing import write_all
from benchmarks.study import say
from rigid.commands.parsing import spoken
from rigid.compute.budget import FIXED_SECONDS, ROBOT_LEARNING_SECONDS, training_speed
from rigid.cores import cores
from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.personalisation import PersonalisationSettings
from rigid.presets import Preset
from rigid.robots.robust_gt import NoTeachersError
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task

TASK = "itch-scratching"


@dataclass(frozen=True)
class Job:
    """One training or one frontier."""

    name: str
    training_steps: int
    """Of a robot."""
    search_steps: int
    """Of adversaries, whose seeds have a core each."""
    is_done: Callable[[], bool]
    do: Callable[[], object]


def run(plan: Plan, *, out: Path, results: Path, spend: float | None = None) -> None:
    """Does what is missing, then writes tables, figures and account from all that stands.

    Args:
        plan: What to do.
        out: Raw trainings and runs.
        results: What is kept and written.
        spend: Begin no job after this time [s]; None for all of them.

    Raises:
        UserError: A place holds something else, or cannot be written.
    """
    places, task = Places(out, results), make_task(TASK)
    measuring = Measuring(plan, places, task)
    missing = [job for job in jobs(plan, measuring, task.horizon) if not job.is_done()]
    if missing:
        say(f"{len(missing)} jobs to go: about {spoken(_expected_seconds(plan, missing, task))}")
    begun = time.monotonic()
    for number, job in enumerate(missing, start=1):
        if spend is not None and time.monotonic() - begun > spend:
            say(f"{spoken(spend)} are spent: {len(missing) - number + 1} jobs are left for later")
            break
        say(f"{number} of {len(missing)}: {job.name}")
        try:
            job.do()
        except NoTeachersError as error:  # Other robots do not wait for this one.
            say(f"left out: {error}")
    write_all(plan, places, measuring)
    say(f"written: {results / 'README.md'}")


def _expected_seconds(plan: Plan, missing: Sequence[Job], task: Task) -> float:
    """How long all of them take together [s]."""
    workers = min(len(cores()), len(plan.preset.seeds))
    training = training_speed(task, ROBOT_LEARNING_SECONDS)
    searching = training_speed(task, workers=workers)
    return sum(
        FIXED_SECONDS + job.training_steps / training + job.search_steps / searching
        for job in missing
    )


def jobs(plan: Plan, measuring: Measuring, horizon: int) -> Iterator[Job]:
    """Everything, in the order in which it is done."""
    of_a_search = plan.preset.env_steps(horizon)
    for seed in plan.robot_seeds:
        yield _pair(plan, measuring, seed, horizon)
        for name in ("vanilla", "robust-gt", "gleave", "palm"):
            yield _training(plan, measuring, name, seed, horizon)
            yield _frontier(measuring, name, seed, of_a_search)
    if plan.variants:
        for name in (SCRATCH, TWICE):
            yield _training(plan, measuring, name, plan.first, horizon)
            yield _frontier(measuring, name, plan.first, of_a_search)
    for label, changes in plan.bodies.items():
        yield _body(plan, measuring, label, changes, of_a_search)
    if plan.thorough is not None:
        for name in RECIPES:
            yield _thoroughly(plan, measuring, name, plan.thorough, horizon)


def _pair(plan: Plan, measuring: Measuring, seed: int, horizon: int) -> Job:
    making, budget = measuring.making, plan.budgets.pair
    return Job(
        f"pair {seed}", budget.iterations * budget.episodes * horizon, 0,
        lambda: making.has_pair(seed), lambda: making.pair(seed),
    )  # fmt: skip


def _training(plan: Plan, measuring: Measuring, name: str, seed: int, horizon: int) -> Job:
    making = measuring.making
    return Job(
        f"robot {name} {seed}", *_steps(plan, name, horizon),
        lambda: making.has_robot(name, seed), lambda: making.robot(name, seed),
    )  # fmt: skip


def _frontier(measuring: Measuring, name: str, seed: int, env_steps: int) -> Job:
    return Job(
        f"frontier of {name} {seed}", 0, env_steps,
        lambda: measuring.has(name, seed), lambda: measuring.robot(name, seed),
    )  # fmt: skip


def _body(
    plan: Plan, measuring: Measuring, label: str, changes: Mapping[str, Any], env_steps: int
) -> Job:
    return Job(
        f"frontier of vanilla {plan.first} with {label}", 0, env_steps,
        lambda: measuring.has(body_run(label), plan.first),
        lambda: measuring.body(label, changes),
    )  # fmt: skip


def _thoroughly(plan: Plan, measuring: Measuring, name: str, preset: Preset, horizon: int) -> Job:
    return Job(
        f"frontier of {name} {plan.first} with preset {preset.name}",
        0, preset.env_steps(horizon),
        lambda: measuring.has(f"{name}{THOROUGH}", plan.first),
        lambda: measuring.thoroughly(name, plan.first, preset),
    )  # fmt: skip


def _steps(plan: Plan, name: str, horizon: int) -> tuple[int, int]:
    """Environment steps of a robot's training, and of the searches that belong to it."""
    budgets = plan.budgets
    of_recipes: dict[str, list[CoOptimisationSettings | PersonalisationSettings]] = {
        "vanilla": [budgets.vanilla],
        "gleave": [budgets.gleave.population, budgets.gleave.personalisation],
        "palm": [budgets.palm.diverse, budgets.palm.palm.personalisation],
        TWICE: [budgets.robust.training] * 2,
    }
    stages = of_recipes.get(name, [budgets.robust.training])
    training = sum(stage.iterations * stage.episodes * horizon for stage in stages)
    searches = {"robust-gt": [plan.scouting], TWICE: [plan.preset]}.get(name, [])
    return training, sum(search.env_steps(horizon) for search in searches)

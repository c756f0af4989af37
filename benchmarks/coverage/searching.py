"""The population: headline numbers of whole searches, one for each seed, of two robots.

The robots are measured at the same time, each in a process on one core: its small computations gain
nothing from a second one (11 core seconds a seed on two cores, 8 on one, measured).
"""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

from benchmarks.coverage.plan import Plan
from benchmarks.study import say
from rigid.commands.parsing import spoken
from rigid.compute.listening import Workload
from rigid.compute.measurement import measure_robot
from rigid.compute.subject import Subject
from rigid.frontier.comparison import HEADLINE_LEVEL, numbers_of
from rigid.frontier.result import Frontier
from rigid.presets import Preset
from rigid.tasks.analytic.offset_catch import OffsetCatch

NUMBERS = ("worst_at", "auc_natural", "auc")
GATED = ("worst_at", "auc")
"""Those that `rigid gate` takes a limit for."""
HULL = "hull_at"
"""Height of the hull at the naturalness of `worst_at`: no headline number, but continuous."""
_SECONDS = 5e-6, 0.4
"""Of one training episode, and of scoring one adversary: for the estimate only (measured)."""
_FIXED_SECONDS = 30.0  # Compilation.


def population(plan: Plan, runs: Path) -> list[dict[str, Any]]:
    """One row for each robot and seed, with the headline numbers.

    Beside `tolerance`, `seed` and those: `hull_at`, and the λ of the adversary that sets `worst_at`
    (None: canonical play does).

    Args:
        plan: The study.
        runs: Holds one run directory for each robot; what is complete there is not made again.

    Raises:
        UserError: `runs` holds searches of other settings.
    """
    seconds = _FIXED_SECONDS + len(plan.preset.seeds) * _seconds_per_seed(plan.preset)
    say(
        f"{len(plan.tolerances)} robots, {len(plan.preset.seeds)} seeds each: about "
        f"{spoken(seconds)} with a free core for each robot"
    )
    context = multiprocessing.get_context("spawn")  # A fork would inherit jax's threads.
    with ProcessPoolExecutor(len(plan.tolerances), mp_context=context) as pool:
        begun = [
            pool.submit(_searched, plan.preset, tolerance, runs / f"tolerance-{tolerance:g}", place)
            for place, tolerance in enumerate(plan.tolerances)
        ]
        return [row for future in begun for row in future.result()]


def _seconds_per_seed(preset: Preset) -> float:
    episode, scoring = _SECONDS
    return sum(preset.per_round) * (preset.iterations * preset.episodes * episode + scoring)


def _searched(preset: Preset, tolerance: float, out: Path, place: int) -> list[dict[str, Any]]:
    """Measures one robot as `rigid frontier` does, in a process of its own."""
    if hasattr(os, "sched_setaffinity"):  # Linux; elsewhere the two share all cores.
        cores = sorted(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {cores[place % len(cores)]})
    subject = Subject(OffsetCatch("failure", tolerance), "builtin:catcher")
    frontier = measure_robot(
        subject, preset, out=out, seeds=preset.seeds, listener=_Lines(f"tolerance {tolerance:g}")
    )
    return rows_of(frontier, tolerance, preset.seeds)


def rows_of(frontier: Frontier, tolerance: float, seeds: Sequence[int]) -> list[dict[str, Any]]:
    """The rows of one robot."""
    numbers = numbers_of(frontier)
    return [
        {"tolerance": tolerance, "seed": seed}
        | {name: numbers[name].by_seed[str(seed)] for name in (*NUMBERS, HULL)}
        | {"worst_lambda": _worst_lambda(frontier, seed)}
        for seed in seeds
    ]


def _worst_lambda(frontier: Frontier, seed: int) -> float | None:
    """λ of the most adversarial point that is natural enough for `worst_at`."""
    natural = [
        point for point in frontier.points
        if point["seed"] == seed and point["naturalness"] >= HEADLINE_LEVEL
    ]  # fmt: skip
    worst = max(natural, key=lambda point: float(point["adversarialness"]), default=None)
    return None if worst is None else float(worst["lambda"])


class _Lines:
    """A line of progress for each tenth, since two bars would fight over the terminal."""

    def __init__(self, what: str) -> None:
        self._what = what
        self._total, self._done, self._said = 1, 0, 0
        self._since = time.monotonic()

    def begin(self, work: Workload) -> None:
        """The estimate that is made for longer episodes is of no use here."""
        self._total, self._done, self._since = work.steps, work.done, time.monotonic()
        self._said = work.done

    def advance(self, env_steps: int) -> None:
        """Steps done since the last call."""
        self._done += env_steps
        fresh, now = self._done - self._said, time.monotonic()
        if 10 * fresh < self._total:
            return
        left = (self._total - self._done) * (now - self._since) / fresh
        say(f"{self._what}: {100 * self._done / self._total:.0f} %, about {spoken(left)} left")
        self._said, self._since = self._done, now

    def say(self, text: str) -> None:
        """A line for the user."""
        say(f"{self._what}: {text}")

"""The study from its plan to its account, which is written anew after every seed."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

from benchmarks.standard.account import account
from benchmarks.standard.costs import cost_rows
from benchmarks.standard.drawing import draw
from benchmarks.standard.making import Workplace
from benchmarks.standard.pairing import pairs_of, seed_rows, table_rows, with_pooled
from benchmarks.standard.plan import Plan
from benchmarks.study import say, write_table
from rigid.commands.parsing import spoken
from rigid.compute.budget import training_speed
from rigid.compute.run_directory import alone_in
from rigid.files import make_room, write_atomically

_ROBOT_SECONDS = 6.0
"""Compilation and canonical episodes of a robot; for the estimate of time only (measured)."""
_PART_SECONDS = 8.0
"""Canonical play and the passive human of a measurement; for the estimate of time only (measured).
"""
_SCORING_SECONDS = 2.0
"""Playing and judging one adversary; for the estimate of time only (measured)."""


def run(plan: Plan, *, out: Path, results: Path) -> None:
    """Makes what is missing in `out`, seed by seed, and writes what is known into `results`.

    Raises:
        UserError: `out` holds parts of another plan, a directory cannot be written, or another
            process is at it.
    """
    make_room(results / "README.md", "--results")
    with alone_in(out):
        place = Workplace(plan, out)
        speed = training_speed(place.task)
        begun, first = time.monotonic(), expected_seconds(place, speed)
        total = sum(len(place.parts(seed)) for seed in plan.seeds)
        say(f"{_missing(place)} of {total} measurements to go: about {spoken(first)}")
        place.make_robots()
        place.check_runs()
        written = False
        for seed in plan.seeds:
            missing = place.missing(seed)
            for part in missing:
                place.measure(part)
                now = expected_seconds(place, speed)
                left = spoken(left_seconds(first, now, time.monotonic() - begun))
                say(f"measured: {part.name}; {_missing(place)} of {total} to go: about {left}")
            if missing:
                write_results(place, results)
                written = True
        if not written:
            write_results(place, results)


def write_results(place: Workplace, results: Path) -> None:
    """Writes tables, figure and account of all pairs that are complete."""
    measured = {robot.name: place.frontiers(robot) for robot in place.plan.robots}
    robots = [pair for name, runs in measured.items() for pair in pairs_of(name, runs)]
    pairs = with_pooled(robots)
    rows, costs = table_rows(pairs), cost_rows(measured)
    write_table(results / "table.csv", rows)
    write_table(results / "seeds.csv", seed_rows(robots))
    write_table(results / "costs.csv", costs)
    draw(results / "figure.svg", pairs, rows)
    text = account(place.plan, measured, rows, costs)
    write_atomically(results / "README.md", text.encode())
    say(f"written: {results / 'README.md'}")


def expected_seconds(place: Workplace, speed: float) -> float:
    """How long what is missing will take [s], at `speed` training steps per second."""
    plan, horizon = place.plan, place.task.horizon
    training = sum(
        _ROBOT_SECONDS + robot.training.iterations * plan.recipe.episodes * horizon / speed
        for robot in place.untrained() if robot.training is not None
    )  # fmt: skip
    presets = {name: replace(preset, seeds=(0,)) for name, preset in plan.presets().items()}
    each = {
        name: preset.adversaries * _SCORING_SECONDS + preset.env_steps(horizon) / speed
        for name, preset in presets.items()
    }
    missing = [part for seed in plan.seeds for part in place.missing(seed)]
    return training + sum(
        _PART_SECONDS + (0.0 if place.is_searched(part) else each[part.preset]) for part in missing
    )


def left_seconds(first: float, now: float, elapsed: float) -> float:
    """An estimate of what is left [s], corrected by how long the work so far took.

    Args:
        first: What was expected at the start, more than 0.
        now: What is expected now of what is left.
        elapsed: Since the start.

    Example:
        >>> left_seconds(100.0, 60.0, elapsed=80.0)
        120.0
    """
    return now * elapsed / (first - now) if now < first else now


def _missing(place: Workplace) -> int:
    return sum(len(place.missing(seed)) for seed in place.plan.seeds)

"""Measuring a robot, end to end: from its policy to `frontier.json` and the report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from rigid.compute.budget import FIXED_SECONDS, TRAINING_SHARE
from rigid.compute.clock import Clock
from rigid.compute.group import GroupInputs, GroupPlan, json_lambda, run_group
from rigid.compute.preparation import (
    Prepared,
    Subject,
    lambdas_of,
    passive_reference,
    prepare,
    seeds_of,
    settings_for,
)
from rigid.compute.run_directory import check_place, command_line, open_run
from rigid.files import json_text, write_atomically
from rigid.frontier.result import Frontier, load_frontier, measured_points
from rigid.frontier.search import next_round
from rigid.frontier.statistics import summarize_seeds
from rigid.presets import Preset


@runtime_checkable
class Listener(Protocol):
    """Who is told how a measurement goes on; the command line draws a progress bar."""

    def begin(self, env_steps: int, seconds: float) -> None:
        """Training starts: total steps, and an estimate of the time it will take."""
        ...

    def advance(self, env_steps: int) -> None:
        """Steps done since the last call, resumed ones included."""
        ...

    def say(self, text: str) -> None:
        """A line for the user."""
        ...


class Silence:
    """A listener that says nothing."""

    def begin(self, env_steps: int, seconds: float) -> None:
        """Ignored."""

    def advance(self, env_steps: int) -> None:
        """Ignored."""

    def say(self, text: str) -> None:
        """Ignored."""


def measure_robot(
    subject: Subject,
    preset: Preset,
    *,
    out: Path,
    seeds: Sequence[int] | None = None,
    lambdas: Sequence[float] | None = None,
    memory: int = 1,
    listener: Listener | None = None,
) -> Frontier:
    """Measures a robot into `out`, or goes on where an earlier call stopped.

    Args:
        subject: Task, robot, human and canonical data.
        preset: Budget.
        out: Run directory.
        seeds: Search seeds instead of the preset's; those that `out` already has stay.
        lambdas: Exactly these λ, without refinement; 0 and inf are allowed.
        memory: Observations that an adversary acts on.
        listener: Told of progress.

    Raises:
        UserError: Bad input; nothing was overwritten.
    """
    listener = listener or Silence()
    clock = Clock()
    settings = settings_for(preset, memory)
    chosen, lambdas = seeds_of(preset, seeds), lambdas_of(lambdas)
    check_place(out)
    prepared = prepare(subject, preset, settings)
    exactly = None if lambdas is None else [json_lambda(value) for value in lambdas]
    opened = open_run(out, {**prepared.identity, "lambdas": exactly}, chosen, command_line())
    run, chosen = opened.directory, opened.seeds
    for warning in opened.warnings:
        listener.say(warning)
    if run.frontier.exists():
        listener.say(f"{out} is already complete; nothing to do")
        return load_frontier(out)
    clock.go_on(run.path / "groups" / "spent.json")

    def advance(env_steps: int) -> None:
        listener.advance(env_steps)
        clock.tick()

    inputs = GroupInputs(
        subject.task, prepared.opponent, prepared.ruler, preset, settings, run.path
    )
    per_seed = len(lambdas) if lambdas is not None else sum(preset.per_round)
    steps = per_seed * len(chosen) * preset.iterations * preset.episodes * subject.task.horizon
    speed = TRAINING_SHARE * prepared.steps_per_second
    listener.begin(steps, FIXED_SECONDS + steps / speed)
    points: list[dict[str, Any]] = []
    for seed in chosen:
        points += _search(inputs, seed, lambdas, advance)
    headline = _headline(points, prepared, chosen)
    passive = passive_reference(subject.task, prepared, preset)
    clock.keep()
    data = {
        "schema": 1,
        "task": subject.task.name,
        "robot": subject.robot,
        "human": subject.human,
        "preset": preset.name,
        "canonical": prepared.canonical,
        **headline,
        "return_range": list(prepared.ruler.return_range),
        "range_source": "task",
        "passive": passive,
        "stamp": preset.stamp,
        **_costs(points, prepared, preset, subject.task.horizon),
        **clock.read(),
    }
    write_atomically(run.frontier, json_text(data, indent=1).encode())
    return load_frontier(out)


def _search(
    inputs: GroupInputs,
    seed: int,
    lambdas: Sequence[float] | None,
    advance: Callable[[int], None],
) -> list[dict[str, Any]]:
    """Algorithm 1 for one seed, or exactly the λ that the user gave."""
    if lambdas is not None:
        return run_group(inputs, GroupPlan(seed, 1, tuple(lambdas)), advance=advance)
    preset = inputs.preset
    trained: list[list[float]] = []
    naturalness: list[list[float]] = []
    points: list[dict[str, Any]] = []
    while True:
        chosen = next_round(
            trained, naturalness, per_round=preset.per_round,
            lambda_min=preset.lambda_min, lambda_max=preset.lambda_max,
        )  # fmt: skip
        if chosen is None:
            return points
        plan = GroupPlan(seed, len(trained) + 1, tuple(chosen))
        found = run_group(inputs, plan, advance=advance)
        trained.append(chosen)
        naturalness.append([point["naturalness_selection"] for point in found])
        points += found


def _headline(
    points: list[dict[str, Any]], prepared: Prepared, seeds: Sequence[int]
) -> dict[str, Any]:
    anchors = dict.fromkeys(seeds, prepared.canonical["adversarialness"])
    summary = summarize_seeds(measured_points(points), anchors, rng=np.random.default_rng(0))
    marked = [
        {**point, "on_frontier": bool(mark)}
        for point, mark in zip(points, summary.on_frontier, strict=True)
    ]
    return {"points": marked, **summary.headline()}


def _costs(
    points: Sequence[dict[str, Any]], prepared: Prepared, preset: Preset, horizon: int
) -> dict[str, int]:
    """Environment steps of training, and of everything that only scores."""
    episodes = preset.referee_episodes + preset.validation_episodes + preset.scoring_episodes
    companions = 2  # Canonical episodes beside the two replays of each adversary.
    scoring = (len(points) * (episodes + companions) + episodes) * horizon
    return {
        "env_steps": sum(point["env_steps"] for point in points),
        "env_steps_scoring": scoring + prepared.env_steps,
    }

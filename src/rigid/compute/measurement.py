"""Measuring a robot, end to end: from its policy to `frontier.json` and the report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from rigid.compute.budget import FIXED_SECONDS, TRAINING_SHARE
from rigid.compute.clock import Clock
from rigid.compute.discriminators import write_discriminators
from rigid.compute.group import GroupInputs, GroupPlan, json_lambda, run_group, search_of
from rigid.compute.preparation import (
    Prepared,
    Subject,
    lambdas_of,
    passive_reference,
    prepare,
    seeds_of,
    settings_for,
)
from rigid.compute.run_directory import (
    OpenRun,
    alone_in,
    check_place,
    command_line,
    open_run,
)
from rigid.files import json_text, write_atomically
from rigid.frontier.result import Frontier, load_frontier, measured_points
from rigid.frontier.search import next_round
from rigid.frontier.statistics import summarize_seeds
from rigid.learning.adversary import AdversarySettings
from rigid.naturalness.choice import DEFAULT_MEASURE
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
    search_measure: str = DEFAULT_MEASURE,
    settings: AdversarySettings | None = None,
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
        search_measure: What holds adversaries close; never what they are judged by.
        settings: How adversaries are trained, in place of what the preset, `memory` and
            `search_measure` say; for studies of the search itself.
        listener: Told of progress.

    Raises:
        UserError: Bad input; nothing was overwritten.
        ValueError: `settings` have another budget than the preset.
    """
    listener = listener or Silence()
    clock = Clock()
    if settings is None:
        settings = settings_for(preset, memory, search_measure)
    elif settings.sharing != preset.sharing:
        raise ValueError(
            f"settings have sharing {settings.sharing}, but preset {preset.name!r} has "
            f"{preset.sharing}"
        )
    elif (settings.iterations, settings.episodes) != (preset.iterations, preset.episodes):
        raise ValueError(
            f"settings train for {settings.iterations} iterations of {settings.episodes} episodes, "
            f"but preset {preset.name!r} for {preset.iterations} of {preset.episodes}"
        )
    chosen, lambdas = seeds_of(preset, seeds), lambdas_of(lambdas)
    check_place(out)
    prepared = prepare(subject, preset, settings)
    exactly = None if lambdas is None else [json_lambda(value) for value in lambdas]
    with alone_in(out):
        opened = open_run(out, {**prepared.identity, "lambdas": exactly}, chosen, command_line())
        for warning in opened.warnings:
            listener.say(warning)
        if opened.directory.frontier.exists():
            complete = load_frontier(out)
            listener.say(f"{out} is already complete; nothing to do")
            return complete
        clock.go_on(opened.directory.path / "groups" / "spent.json")
        data = _measured(subject, prepared, preset, settings, opened, lambdas, clock, listener)
        write_atomically(opened.directory.frontier, json_text(data, indent=1).encode())
    return load_frontier(out)


def _measured(
    subject: Subject,
    prepared: Prepared,
    preset: Preset,
    settings: AdversarySettings,
    opened: OpenRun,
    lambdas: Sequence[float] | None,
    clock: Clock,
    listener: Listener,
) -> dict[str, Any]:
    """Searches every seed and sums up: what `frontier.json` holds."""

    def advance(env_steps: int) -> None:
        listener.advance(env_steps)
        clock.tick()

    inputs = GroupInputs(
        prepared.task, prepared.opponent, prepared.ruler, preset, settings, opened.directory.path
    )
    steps = len(opened.seeds) * _steps_of_a_seed(inputs, lambdas)
    speed = TRAINING_SHARE * prepared.steps_per_second
    listener.begin(steps, FIXED_SECONDS + steps / speed)
    points: list[dict[str, Any]] = []
    for seed in opened.seeds:
        found = _search(inputs, seed, lambdas, advance)
        write_discriminators(inputs, seed, [point["id"] for point in found])
        points += found
    headline = _headline(points, prepared, opened.seeds)
    passive = passive_reference(prepared.task, prepared, preset)
    clock.keep()
    return {
        "schema": 1,
        "task": subject.task.name,
        "robot": subject.robot,
        "human": subject.human,
        "preset": preset.name,
        "search_measure": prepared.identity["measure"],
        "features": prepared.identity["features"],
        "canonical": prepared.canonical,
        **headline,
        "return_range": list(prepared.ruler.return_range),
        "range_source": "task",
        "passive": passive,
        "stamp": preset.stamp,
        **_costs(points, prepared, preset, subject.task.horizon),
        **clock.read(),
    }


def _steps_of_a_seed(inputs: GroupInputs, lambdas: Sequence[float] | None) -> int:
    """Environment steps of training."""
    preset, horizon = inputs.preset, inputs.task.horizon
    if lambdas is None:
        return replace(preset, seeds=preset.seeds[:1]).env_steps(horizon)
    blocks = search_of(inputs, GroupPlan(0, 1, tuple(lambdas))).blocks
    return blocks * preset.iterations * preset.episodes * horizon


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

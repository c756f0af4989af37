"""How long a measurement takes here, and a preset that fits a given time."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path

import numpy as np

from rigid.compute.executors.executor import workers_on_this_machine
from rigid.errors import UserError
from rigid.learning.conditioned import Sharing
from rigid.presets import Preset
from rigid.tasks.protocol import Task

LEARNING_SECONDS = 1.5e-4
"""Time that learning takes one process for each step, beside the step itself [s]; for estimates of
time only (measured .9e-4 to 2.3e-4)."""
_ON_ONE_CORE = 1.4
"""Time that stepping takes on one core, over that on all; for estimates of time only (measured 1.4
to 1.7 on two: policies and what Python does are not divided among threads)."""
ROBOT_LEARNING_SECONDS = 7e-5
"""As `LEARNING_SECONDS`, of robots, who have no discriminator (measured .4e-4 to .9e-4)."""
STARTING_SECONDS = 4.0
"""Compilation of a robot's training (measured 2-6 s)."""
COMPILING_SECONDS = 35.0
"""Compilation of training and referees (measured 20-40 s), in resumed measurements too."""
FIXED_SECONDS = 40.0
"""Compilation, canonical episodes, the report (measured 30-50 s on two cores)."""
_LEAST_ITERATIONS = 20
_PROBE_WORLDS, _PROBE_STEPS, _PROBE_SECONDS = 192, 20, 0.5


def training_speed(task: Task, learning: float = LEARNING_SECONDS, *, workers: int = 1) -> float:
    """Expected training steps per second, from half a second of stepping.

    Args:
        task: Any.
        learning: Time that learning takes one process for each step [s].
        workers: One process on all cores, or so many with a core each.
    """
    return working_speed(stepping_speed(task), workers, learning=learning)


def stepping_speed(task: Task) -> float:
    """Steps per second without learning of one process on all cores, from half a second."""
    world = task.make_world(_PROBE_WORLDS)
    world.reset(np.arange(_PROBE_WORLDS))
    robot = np.zeros((_PROBE_WORLDS, task.robot.action_size))
    human = np.zeros((_PROBE_WORLDS, task.human.action_size))
    begun, steps, seconds = time.perf_counter(), 0, 0.0
    while steps < _PROBE_STEPS and seconds < _PROBE_SECONDS:
        world.step(robot, human)
        steps, seconds = steps + 1, time.perf_counter() - begun
    return _PROBE_WORLDS * steps / seconds


def working_speed(
    stepping: float, workers: int = 1, *, learning: float = LEARNING_SECONDS
) -> float:
    """Expected steps per second of training and scoring.

    Args:
        stepping: Steps per second without learning, of one process on all cores of this machine.
        workers: One process on all cores, or so many with a core each.
        learning: Time that learning takes one process for each step [s].
    """
    slower = 1.0 if workers == 1 else _ON_ONE_CORE
    return workers / (slower / stepping + learning)


def fit_here(preset: Preset, seconds: float, task: Task) -> Preset:
    """The preset with fewer iterations, then fewer seeds, so that it takes this machine `seconds`.

    Raises:
        UserError: Not even one seed with 20 iterations fits.
    """
    stepping, steps = stepping_speed(task), preset.env_steps(task.horizon)
    return fit_to(
        preset, seconds, horizon=task.horizon,
        speed=lambda workers: working_speed(stepping, workers),
        workers=workers_on_this_machine(len(preset.seeds), steps, task),
    )  # fmt: skip


def fit_to(
    preset: Preset, seconds: float, *, horizon: int, speed: Callable[[int], float], workers: int = 1
) -> Preset:
    """The preset with fewer iterations, then fewer seeds, so that it takes about `seconds`.

    Args:
        preset: What there is to do, if there is time.
        seconds: There are [s].
        horizon: Of the task.
        speed: Steps per second of so many processes, as of `working_speed`.
        workers: Processes that would share the seeds, one seed each at a time. Where the time does
            not suffice for as many seeds, one process is reckoned with.

    Raises:
        UserError: Not even one seed with 20 iterations fits.
    """
    for count in (workers, 1):
        affordable = max(seconds - FIXED_SECONDS, 0.0) * speed(count)
        fitted = _fitted(preset, affordable, horizon, count)
        if fitted is not None:
            return fitted
    least = replace(
        preset, seeds=preset.seeds[:1], iterations=min(_LEAST_ITERATIONS, preset.iterations)
    )
    needed = FIXED_SECONDS + _work(least, horizon) / speed(1)
    raise UserError(
        f"--budget is too short for preset {preset.name!r}: one seed of {least.iterations} "
        f"iterations takes about {needed:.0f} s here, more than the {seconds:g} s given"
    )


def _fitted(preset: Preset, affordable: float, horizon: int, workers: int) -> Preset | None:
    """The preset within so many steps, those among them that idle workers could have done."""
    turns = -(-len(preset.seeds) // workers)

    def work(turns: int, iterations: int) -> int:
        """Of workers that search a seed in each turn, also where the last turn lacks seeds."""
        each = replace(preset, seeds=preset.seeds[:1], iterations=iterations)
        return turns * workers * _work(each, horizon)

    if work(turns, preset.iterations) <= affordable:
        return preset
    scoring = work(turns, 0)
    share = (affordable - scoring) / (work(turns, preset.iterations) - scoring)
    least = min(_LEAST_ITERATIONS, preset.iterations)
    iterations = max(int(share * preset.iterations), least)
    turns = int(affordable // work(1, iterations))
    if turns < 1:
        return None
    return replace(preset, iterations=iterations, seeds=preset.seeds[: turns * workers])


def _work(preset: Preset, horizon: int) -> int:
    """Steps of training and scoring."""
    return preset.env_steps(horizon) + preset.scoring_steps(preset.adversaries, horizon)


def stored_preset(directory: Path, preset: Preset) -> Preset | None:
    """The budget of a measurement that was begun in `directory`, None where there is none.

    A budget in minutes resolves to other numbers at another moment, so a resumed run keeps its own.
    """
    try:
        settings = json.loads((directory / "settings.json").read_bytes())
        stored = settings["identity"]["preset"]
        known = {field.name: stored[field.name] for field in fields(Preset) if field.name in stored}
        known |= {"per_round": tuple(stored["per_round"]), "seeds": tuple(settings["seeds"])}
        sharing = known.get("sharing")  # Runs of before it was known have none.
        known["sharing"] = None if sharing is None else Sharing(**sharing)
    except (OSError, ValueError, KeyError, TypeError):
        return None  # No measurement, or one that will be refused with its reason.
    return replace(preset, **known)

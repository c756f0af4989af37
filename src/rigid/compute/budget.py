"""How long a measurement takes here, and a preset that fits a given time."""

from __future__ import annotations

import json
import time
from dataclasses import fields, replace
from pathlib import Path

import numpy as np

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
    world = task.make_world(_PROBE_WORLDS)
    world.reset(np.arange(_PROBE_WORLDS))
    robot = np.zeros((_PROBE_WORLDS, task.robot.action_size))
    human = np.zeros((_PROBE_WORLDS, task.human.action_size))
    begun, steps, seconds = time.perf_counter(), 0, 0.0
    while steps < _PROBE_STEPS and seconds < _PROBE_SECONDS:
        world.step(robot, human)
        steps, seconds = steps + 1, time.perf_counter() - begun
    return working_speed(_PROBE_WORLDS * steps / seconds, workers, learning=learning)


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


def fit_to(preset: Preset, seconds: float, *, horizon: int, steps_per_second: float) -> Preset:
    """The preset with fewer iterations, then fewer seeds, so that it takes about `seconds`.

    Raises:
        UserError: Not even one seed with 20 iterations fits.
    """
    affordable = max(seconds - FIXED_SECONDS, 0.0) * steps_per_second
    if _work(preset, horizon) <= affordable:
        return preset
    training = preset.env_steps(horizon)
    share = (affordable - (_work(preset, horizon) - training)) / training
    least = min(_LEAST_ITERATIONS, preset.iterations)
    iterations = max(int(share * preset.iterations), least)
    per_seed = _work(replace(preset, seeds=preset.seeds[:1], iterations=iterations), horizon)
    seeds = int(affordable // per_seed)
    if seeds < 1:
        needed = FIXED_SECONDS + per_seed / steps_per_second
        raise UserError(
            f"--budget is too short for preset {preset.name!r}: one seed of {least} iterations "
            f"takes about {needed:.0f} s here, more than the {seconds:g} s given"
        )
    return replace(preset, iterations=iterations, seeds=preset.seeds[:seeds])


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

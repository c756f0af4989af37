"""Speed, as figures measured side by side in one run: `rigid bench`.

Physics is the same scene in MuJoCo's own batch, driven through the same motion with ready targets,
so that it has the same contacts; training is everything that one iteration of a group of
adversaries takes. Both have one thread, as a worker of a measurement has. They, their parts, and
whatever else is timed often go by turns.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import jax
import numpy as np

from rigid._version import __version__
from rigid.compute.playing import play_with
from rigid.compute.preparation import prepare, settings_for
from rigid.compute.run.clock import Clock
from rigid.compute.search.group import run_group
from rigid.compute.search.group_plan import GroupInputs, GroupPlan
from rigid.compute.search.scoring import seen_by_referee
from rigid.compute.speed.iteration_parts import Iteration
from rigid.compute.speed.timing import in_turns, spread_of, timed
from rigid.compute.subject import Subject
from rigid.errors import UserError
from rigid.frontier.largest_jump import first_lambdas
from rigid.frontier.result import Frontier
from rigid.learning.group_play import group_actor
from rigid.naturalness.panel import train_panels
from rigid.presets import PRESETS, Preset
from rigid.tasks.itch_scratching.task import ItchScratching

THREADS = 1
"""Of what is timed: as many as a group has in a measurement with a process for each core."""
GROUPS_OF_PAPER = 9
"""Three seeds of three rounds: what one full round is multiplied by."""
SMALL = Preset(
    name="small", seeds=(0,), per_round=(2,), iterations=2, episodes=8, scoring_episodes=20,
    referee_episodes=8, validation_episodes=4, referee_canonical=20,
)  # fmt: skip
"""The run whose report is drawn: two adversaries, two replays each, as of every preset. Ours."""


def group_inputs(preset: Preset, directory: Path) -> GroupInputs:
    """What the groups of a measurement of the bundled robot share."""
    settings = settings_for(preset)
    subject = Subject(ItchScratching(), "builtin:vanilla")
    prepared = prepare(subject, preset, settings)
    return GroupInputs(
        subject.task, prepared.opponent, prepared.ruler, preset, settings, directory, THREADS
    )


def figures_in_turns(repeats: int) -> dict[str, Any]:
    """Everything that is timed often, by turns, as `rigid bench --json` has it.

    Args:
        repeats: Turns that count.
    """
    with TemporaryDirectory() as directory:
        iteration = Iteration(group_inputs(PRESETS["paper"], Path(directory)))
        works: dict[str, Callable[[], object]] = {
            "startup": start_up,
            "physics": iteration.physics,
            "stepping": iteration.stepping,
            "inference": iteration.inference,
            "whole": iteration.whole,
            "ppo": iteration.ppo,
            "discriminator": iteration.discriminator,
            "referee": referee_work(iteration),
        }
        drawn = report_work(Path(directory))
        if drawn is not None:
            works["report"] = drawn
        seconds = in_turns(works, repeats, before=iteration.renew)
    return figures(seconds, iteration.env_steps, iteration.adversaries)


def start_up() -> None:
    """`rigid --help` in a fresh process."""
    subprocess.run([sys.executable, "-m", "rigid", "--help"], capture_output=True, check=True)


def referee_work(iteration: Iteration) -> Callable[[], object]:
    """Training of the panels of one group, on episodes that are played now."""
    inputs = iteration.inputs
    preset, ruler = inputs.preset, inputs.ruler
    count = preset.referee_episodes + preset.validation_episodes
    policies = [adversary.learner.policy for adversary in iteration.group]
    episodes = play_with(
        inputs.task, inputs.opponent.robot, group_actor(policies, np.random.default_rng(0)),
        np.arange(count), humans=len(policies),
    )  # fmt: skip
    seen = []
    for first in range(0, len(policies) * count, count):
        own = seen_by_referee(episodes, slice(first, first + count))
        train, validation = slice(preset.referee_episodes), slice(preset.referee_episodes, None)
        seen.append((own.part(train), own.part(validation)))
    return lambda: train_panels(ruler.folds, seen, ruler.settings, jax.random.key(0))


def report_work(directory: Path) -> Callable[[], object] | None:
    """Drawing of the report of a small run, which is measured now; None without a front end."""
    frontier = small_run(directory / "small")
    try:
        frontier.report()
    except UserError:  # A checkout that nobody has bundled yet: there is no page to draw.
        return None
    return frontier.report


def small_run(directory: Path) -> Frontier:
    """A finished run of `SMALL`."""
    from rigid.api import measure

    return measure("itch-scratching", "builtin:vanilla", preset=SMALL, out=directory)


def figures(
    seconds: Mapping[str, Sequence[float]], env_steps: int, adversaries: int
) -> dict[str, Any]:
    """What `rigid bench --json` says of times by turns.

    Args:
        seconds: Of each work, one for each turn [s]; `report` may be missing.
        env_steps: Environment steps that physics, stepping, inference and training go through.
        adversaries: In the group.
    """
    s = {name: np.asarray(found) for name, found in seconds.items()}
    known = {
        "startup_s": s["startup"],
        "physics_env_steps_per_s": env_steps / s["physics"],
        "training_env_steps_per_s": env_steps / s["whole"],
        "training_over_physics": s["physics"] / s["whole"],
        "discriminator_updates_per_s": adversaries / s["discriminator"],
        "referee_s": s["referee"],
    }
    if "report" in s:
        known["report_s"] = s["report"]
    budget = {name: 1e6 * part / env_steps for name, part in _budget(s).items()}
    median, quartiles = _spreads(known)
    parts, quartiles_of_parts = _spreads(budget)
    return {
        "report_s": None,
        **median,
        "budget_per_env_step_us": parts,
        "spread": {**quartiles, "budget_per_env_step_us": quartiles_of_parts},
        "repeats": len(s["whole"]),
    }


def _budget(s: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Where the time of an iteration goes; what no part explains is the rest, of either sign."""
    parts = s["stepping"] + s["inference"] + s["ppo"] + s["discriminator"]
    return {
        "physics": s["physics"],
        "observation_and_reward": s["stepping"] - s["physics"],
        "inference": s["inference"],
        "ppo": s["ppo"],
        "discriminator": s["discriminator"],
        "rest": s["whole"] - parts,
        "total": s["whole"],
    }


def _spreads(
    values: Mapping[str, np.ndarray],
) -> tuple[dict[str, float | int], dict[str, list[float | int]]]:
    spreads = {name: spread_of(found.tolist()) for name, found in values.items()}
    return (
        {name: rounded(spread.median) for name, spread in spreads.items()},
        {name: [rounded(spread.low), rounded(spread.high)] for name, spread in spreads.items()},
    )


def rounded(value: float) -> float | int:
    """As many digits as a figure of speed is good for.

    Example:
        >>> rounded(17123.4), rounded(0.24136)
        (17123, 0.241)
    """
    return round(value) if abs(value) >= 1000 else round(value, 3)


def paper_core_hours() -> dict[str, float]:
    """Core-hours of preset `paper`: one full round of one seed, scoring included, times nine."""
    preset = PRESETS["paper"]
    with TemporaryDirectory() as directory:
        inputs = group_inputs(preset, Path(directory))
        lambdas = first_lambdas(preset.lambda_min, preset.lambda_max, preset.per_round[0])
        clock = Clock()
        with clock.working():
            run_group(inputs, GroupPlan(0, 1, tuple(lambdas)))
        spent = clock.read()
    return {
        "paper_core_hours": round(GROUPS_OF_PAPER * spent["core_seconds"] / 3600, 3),
    }


def standard_wall_seconds() -> float:
    """Wall time of a whole measurement with preset `standard` [s]."""
    from rigid.api import measure

    with TemporaryDirectory() as directory:
        return timed(
            lambda: measure("itch-scratching", "builtin:vanilla", out=Path(directory) / "run")
        )


def machine() -> dict[str, Any]:
    """What the figures were measured on."""
    task = ItchScratching()
    return {
        "rigid": __version__,
        "threads": THREADS,
        "physics_step": task.parameters.physics_step,
        "substeps": task.parameters.substeps,
        "machine": {
            "processor": _processor(),
            "cores": os.cpu_count(),
            "system": f"{platform.system()} {platform.release()}",
            "python": platform.python_version(),
            "mujoco": metadata.version("mujoco"),
            "jax": metadata.version("jax"),
            "load": round(os.getloadavg()[0], 2),
        },
    }


def _processor() -> str:
    path = Path("/proc/cpuinfo")
    lines = path.read_text().splitlines() if path.exists() else []
    named = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return named[0] if named else platform.processor() or platform.machine()

"""Speed, as ratios measured side by side in one run: `rigid bench`.

A ratio of two things timed in turns holds on a busy machine, where seconds do not. Physics is the
same scene in MuJoCo's own batch, driven through the same motion with ready targets, so that it has
the same contacts; training is everything that one iteration of a group of adversaries takes.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from importlib import metadata
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Float
from mujoco.batch import Batch

from rigid._version import __version__
from rigid.compute.clock import Clock
from rigid.compute.group import GroupInputs, GroupPlan, run_group
from rigid.compute.preparation import Subject, prepare, settings_for
from rigid.compute.scoring import play_with
from rigid.frontier.largest_jump import first_lambdas
from rigid.learning.adversary import Adversary, start_adversary, train_iteration
from rigid.learning.group_play import group_actor
from rigid.presets import PRESETS, Preset
from rigid.tasks.itch_scratching.task import ItchScratching

GROUPS_OF_PAPER = 9
"""Three seeds of three rounds: what one full round is multiplied by."""


class Speed(NamedTuple):
    """Environment steps per second: medians over repeats, and the median of their ratios."""

    physics: float
    training: float
    ratio: float


def start_up_seconds(repeats: int) -> float:
    """Median time of `rigid --help` in a fresh process [s]."""
    command = [sys.executable, "-m", "rigid", "--help"]
    return median(
        _timed(lambda: subprocess.run(command, capture_output=True, check=True))
        for _ in range(repeats)
    )


def group_inputs(preset: Preset, directory: Path) -> GroupInputs:
    """What the groups of a measurement of the bundled robot share."""
    settings = settings_for(preset)
    subject = Subject(ItchScratching(), "builtin:vanilla")
    prepared = prepare(subject, preset, settings)
    return GroupInputs(subject.task, prepared.opponent, prepared.ruler, preset, settings, directory)


def training_against_physics(inputs: GroupInputs, repeats: int) -> Speed:
    """Times iterations of a whole group and the bare physics of the same motion, in turns."""
    task, preset = inputs.task, inputs.preset
    assert isinstance(task, ItchScratching)
    lambdas = first_lambdas(preset.lambda_min, preset.lambda_max, preset.per_round[0])
    keys = jax.random.split(jax.random.key(0), len(lambdas))
    group = [
        start_adversary(inputs.opponent, inputs.settings, lambda_, key)
        for lambda_, key in zip(lambdas, keys, strict=True)
    ]
    world = task.make_world(len(group) * preset.episodes)
    physics, training = [], []
    for repeat in range(repeats + 1):
        motion = _motion(inputs, group)
        bare = _timed(partial(step_through, task, motion))
        begun = time.perf_counter()
        results = train_iteration(task, world, group, inputs.opponent, inputs.settings, seed=0)
        assert all(np.isfinite(metrics.penalty) for _, metrics in results)  # Waits for them.
        whole = time.perf_counter() - begun
        group = [adversary for adversary, _ in results]
        if repeat:  # The first one compiles.
            physics.append(bare)
            training.append(whole)
    steps = world.batch * task.horizon
    ratio = median(bare / whole for bare, whole in zip(physics, training, strict=True))
    return Speed(steps / median(physics), steps / median(training), ratio)


def _motion(inputs: GroupInputs, group: list[Adversary]) -> np.ndarray:
    """State and targets of one set of episodes of the group, shape (T + 1, B, state)."""
    snapshots: list[np.ndarray] = []
    policies = [adversary.learner.policy for adversary in group]
    actor = group_actor(policies, np.random.default_rng(0))
    starts = np.arange(inputs.preset.episodes)
    play_with(
        inputs.task, inputs.opponent.robot, actor, starts, humans=len(group), snapshots=snapshots
    )
    return np.stack(snapshots)


def step_through(
    task: ItchScratching, motion: Float[np.ndarray, "T1 B state"]
) -> Float[np.ndarray, "B q"]:
    """The motion of recorded snapshots again, with ready targets: nothing but MuJoCo.

    Returns:
        Joint angles at its end [rad].
    """
    size = task.model.nq
    batch = Batch(task.model, motion.shape[1])
    batch.bind("qpos")[:] = motion[0, :, :size]
    target = batch.bind("ctrl")
    for snapshot in motion[1:]:
        target[:] = snapshot[:, 2 * size : 3 * size]
        batch.step(nstep=task.parameters.substeps)
    return np.array(batch.bind("qpos"))


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
        "paper_wall_hours": round(GROUPS_OF_PAPER * spent["wall_seconds"] / 3600, 3),
    }


def standard_wall_seconds() -> float:
    """Wall time of a whole measurement with preset `standard` [s]."""
    from rigid.api import measure

    with TemporaryDirectory() as directory:
        return _timed(
            lambda: measure("itch-scratching", "builtin:vanilla", out=Path(directory) / "run")
        )


def machine() -> dict[str, Any]:
    """What the figures were measured on."""
    task = ItchScratching()
    return {
        "rigid": __version__,
        "threads": len(os.sched_getaffinity(0)),
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


def _timed(work: Callable[[], object]) -> float:
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun

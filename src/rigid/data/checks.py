"""What is wrong with canonical episodes, said so that the person who recorded them can mend it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rigid.data.about import About
from rigid.errors import UserError
from rigid.files import first_difference
from rigid.tasks.protocol import Task

_PER_STEP = {"features": 3, "observations": 3, "actions": 3, "rewards": 2, "times": 2}
"""Arrays with a row for each step, and their dimensions."""


def check_task(
    description: Mapping[str, Any], feature_names: Sequence[str], task: Task, *, where: Path
) -> None:
    """Refuses episodes of another task, or of the same one with other parameters or features.

    Args:
        description: `Task.describe()` of the task they were recorded in.
        feature_names: What they call their features.
        task: The task they are meant for.
        where: The file; begins every message.

    Raises:
        UserError: The message names both values.
    """
    recorded = description.get("name")
    if recorded != task.name:
        raise UserError(
            f"{where} holds episodes of task {recorded!r}, not {task.name!r}: "
            f"record some with `rigid record --task {task.name}`, or name theirs with --task"
        )
    difference = first_difference(description, task.describe())
    if difference is not None:
        name, theirs, ours = difference
        raise UserError(
            f"{where} was recorded with {name} = {theirs!r}, but task {task.name!r} has {ours!r}: "
            "record it again in this task"
        )
    if tuple(feature_names) != tuple(task.feature_names):
        raise UserError(f"{where} {_feature_difference(feature_names, task)}")


def check_values(
    arrays: Mapping[str, np.ndarray],
    feature_names: Sequence[str],
    *,
    where: Path,
    task: Task | None = None,
) -> None:
    """Refuses arrays that are empty, disagree in length, are too short, or hold NaN.

    Args:
        arrays: The arrays of `CanonicalEpisodes`, by field name; optional ones may be absent.
        feature_names: A name for each feature.
        where: The file; begins every message.
        task: Gives the number of steps and the sizes that they need; None for any.

    Raises:
        UserError: The message says where the fault is and what to do about it.
    """
    features = arrays["features"]
    if features.ndim != 3 or 0 in features.shape[:2]:
        raise UserError(
            f"{where}: features have shape {features.shape}, not (episodes, steps, features) with "
            "at least one episode of one step: record it again"
        )
    if features.shape[2] != len(feature_names):
        raise UserError(
            f"{where} names {len(feature_names)} features, but holds {features.shape[2]}: "
            "give each feature its name"
        )
    _check_lengths(arrays, where)
    if task is not None:
        _check_sizes(arrays, task, where)
    names = {"features": feature_names}
    if task is not None:
        names["observations"] = task.human.observation_names
    for name in _PER_STEP:
        if name in arrays:
            _check_finite(arrays[name], name, names.get(name, ()), where)
    for name in ("returns", "success"):  # NaN there says that nobody knows.
        if name in arrays and np.isinf(arrays[name]).any():
            episode = int(np.flatnonzero(np.isinf(arrays[name]))[0])
            raise UserError(
                f"{where}: {name} are infinite, first in episode {episode}: give NaN where unknown"
            )
    _check_success(arrays, where)
    _check_seeds(arrays, where)


def _check_success(arrays: Mapping[str, np.ndarray], where: Path) -> None:
    success = arrays.get("success", np.zeros(0))
    odd = np.flatnonzero(~(np.isnan(success) | (success == 0) | (success == 1)))
    if len(odd):
        raise UserError(
            f"{where}: success of episode {odd[0]} is {success[odd[0]]:g}, but must be 1 or 0 by "
            "the task's criterion, or NaN where nobody knows"
        )


def _check_seeds(arrays: Mapping[str, np.ndarray], where: Path) -> None:
    seeds = arrays.get("seeds", np.zeros(0, dtype=np.int64))
    odd = np.flatnonzero(seeds < 0)
    if len(odd):
        raise UserError(
            f"{where}: the seed of episode {odd[0]} is {seeds[odd[0]]}, but must be 0 or more"
        )


def _check_lengths(arrays: Mapping[str, np.ndarray], where: Path) -> None:
    episodes, steps = arrays["features"].shape[:2]
    for name, array in arrays.items():
        dimensions = _PER_STEP.get(name, 1)
        expected = (episodes, steps) if name in _PER_STEP else (episodes,)
        if array.ndim != dimensions or array.shape[: len(expected)] != expected:
            raise UserError(
                f"{where}: {name} have shape {array.shape}, but there are features for {episodes} "
                f"episodes of {steps} steps: record everything at every step"
            )


def _check_sizes(arrays: Mapping[str, np.ndarray], task: Task, where: Path) -> None:
    steps = arrays["features"].shape[1]
    if steps != task.horizon:
        raise UserError(
            f"{where} has episodes of {steps} steps, but those of {task.name!r} have "
            f"{task.horizon}: record whole episodes"
        )
    sizes = {"observations": task.human.observation_size, "actions": task.human.action_size}
    for name, size in sizes.items():
        if name in arrays and arrays[name].shape[2] != size:
            raise UserError(
                f"{where} holds {arrays[name].shape[2]} {name} a step, but the human of "
                f"{task.name!r} has {size}: record it again in this task"
            )


def _check_finite(array: np.ndarray, name: str, names: Sequence[str], where: Path) -> None:
    broken = np.argwhere(~np.isfinite(array))
    if not broken.size:
        return
    episode, step, *column = (int(index) for index in broken[0])
    which = "".join(f", {name.removesuffix('s')} {repr(names[c]) if names else c}" for c in column)
    raise UserError(
        f"{where}: {name} hold {len(broken)} numbers that are not finite, the first in episode "
        f"{episode}, step {step}{which}: leave such episodes out"
    )


def check_notes(about: About, episodes: int, *, where: Path) -> None:
    """Refuses notes of another number of episodes than there are.

    Raises:
        UserError: The message names both numbers.
    """
    notes = len(about.episodes)
    if notes not in {0, episodes}:
        raise UserError(
            f"{where} has notes on {notes} episodes, but holds {episodes}: give each its own"
        )


def _feature_difference(found: Sequence[str], task: Task) -> str:
    """Where the names of features differ first."""
    wanted = task.feature_names
    if len(found) != len(wanted):
        return (
            f"has {len(found)} features, but task {task.name!r} has {len(wanted)} "
            f"({', '.join(wanted)}): record it again in this task"
        )
    index = next(i for i, pair in enumerate(zip(found, wanted, strict=True)) if len(set(pair)) > 1)
    return (
        f"calls feature {index} {found[index]!r}, but task {task.name!r} calls it "
        f"{wanted[index]!r}: bring the features in the task's order"
    )

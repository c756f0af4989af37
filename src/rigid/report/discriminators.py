"""What the report shows of a run's discriminators: accuracies, and poses with a verdict."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rigid.compute.search.discriminator_files import Poses, file_of, load_discriminators
from rigid.errors import UserError
from rigid.frontier.result import Frontier
from rigid.report.poses import encode_poses
from rigid.tasks.protocol import DrawsFeatures, Task


def discriminators(frontier: Frontier, task: Task | None) -> dict[str, Any] | None:
    """By search seed `rigid.report.payload.Discriminators`; None where a run examined none.

    Args:
        frontier: The run.
        task: One of RIGID's own, to draw poses; None for no poses.

    Raises:
        UserError: A file is damaged.
    """
    found = {}
    for seed in map(int, frontier.data["auc_by_seed"]):
        stored = load_discriminators(frontier.directory, seed)
        if stored is None:
            continue
        try:
            poses = _drawn(task, stored.poses)
        except ValueError as error:
            where = file_of(frontier.directory, seed)
            cure = "delete it to draw the report without it"
            raise UserError(f"{where} has poses that no arm takes ({error}): {cure}") from None
        found[str(seed)] = {**stored.model_dump(exclude={"format", "poses"}), "poses": poses}
    return found or None


def _drawn(task: Task | None, poses: Poses) -> dict[str, Any] | None:
    """Every pose in the scene's bodies; None where the task cannot draw these features."""
    if task is None or not isinstance(task, DrawsFeatures):
        return None
    noisy = _moments(task, poses.names, [step for level in poses.noisy for step in level])
    if noisy is None:
        return None
    own = {human: _moments(task, poses.names, steps) for human, steps in poses.own.items()}
    return {"levels": poses.levels, "noisy": noisy, "own": own}


def _moments(
    task: DrawsFeatures, names: Sequence[str], steps: Sequence[Sequence[float]]
) -> dict[str, Any] | None:
    features = np.array(steps, dtype=np.float64).reshape(len(steps), len(names))
    shown = task.human_poses(names, features)
    if shown is None:
        return None
    poses = encode_poses(shown["poses"])
    return {"frames": len(steps), "bodies": shown["bodies"], "poses": poses}

"""How episodes ended, and what that says about the pair that played them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Int, Shaped

from rigid.learning.rollout import Trajectories
from rigid.tasks.protocol import Task, adversarialness


class Ended(NamedTuple):
    """How episodes ended, each array (N,)."""

    returns: Float[np.ndarray, " N"]
    faulted: Float[np.ndarray, " N"]
    success: Float[np.ndarray, " N"]
    outcome: Int[np.ndarray, " N"]
    peak_force: Float[np.ndarray, " N"]
    impulse: Float[np.ndarray, " N"]


def ended(episodes: Trajectories) -> Ended:
    """The endings of episodes that were played."""
    summary = episodes.summary
    return Ended(
        episodes.returns, episodes.faulted, summary.success, summary.outcome,
        summary.peak_force, summary.impulse,
    )  # fmt: skip


def measure(
    episodes: Ended, mine: slice, task: Task, return_range: tuple[float, float] | None
) -> dict[str, Any]:
    """Adversarialness, success, outcomes and forces of one human's episodes; None is unknown.

    Episodes that ran away count as faults and nowhere else.
    """
    part = Ended(*(column[mine] for column in episodes))
    sound = part.faulted == 0
    kept = Ended(*(column[sound] for column in part))
    y = None if return_range is None else _mean(adversarialness(kept.returns, return_range))
    return {
        "adversarialness": y,
        "return": _mean(kept.returns),
        "return_std": float(kept.returns.std()) if sound.any() else None,
        "success": _mean(kept.success),
        "episodes": int(sound.size),
        "outcomes": {
            name: _mean(kept.outcome == index) for index, name in enumerate(task.outcome_names)
        },
        "peak_force": _mean(kept.peak_force),
        "impulse": _mean(kept.impulse),
        "faults": int((~sound).sum()),
    }


def _mean(values: Shaped[np.ndarray, " n"]) -> float | None:
    """None for no values, or where one is unknown (NaN)."""
    mean = float(np.mean(values)) if len(values) else np.nan
    return None if np.isnan(mean) else mean

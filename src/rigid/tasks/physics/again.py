"""An episode simulated again at a millisecond, for forces that people look at.

Training runs at 0.02 s, where a hit lasts a step or two. Every control step is simulated again from
its recorded state with physics steps of at most 0.001 s, all steps side by side; the recorded
motion stays, and contacts are resolved in time.
"""

from __future__ import annotations

import mujoco
import numpy as np
from jaxtyping import Float
from mujoco.batch import Batch

FINE_STEP = 0.001
"""Longest physics step of forces that people look at [s] (ours)."""


def fine_steps(control: float) -> tuple[float, int]:
    """A physics step [s] of at most `FINE_STEP`, and how many fill a control step of that length.

    Example:
        >>> fine_steps(0.1)
        (0.001, 100)
    """
    count = int(np.ceil(control / FINE_STEP))
    return control / count, count


def simulate_again(
    model: mujoco.MjModel, snapshots: Float[np.ndarray, "T1 state"], count: int
) -> Float[np.ndarray, "T S n"]:
    """Sensors of every fine physics step: one world for each control step of the episode.

    Args:
        model: The scene with the fine physics step.
        snapshots: Angles, velocities and targets come first.
        count: Physics steps of a control step.
    """
    size = model.nq
    batch = Batch(model, len(snapshots) - 1)
    batch.bind("qpos")[:] = snapshots[:-1, :size]
    batch.bind("qvel")[:] = snapshots[:-1, size : 2 * size]
    batch.bind("ctrl")[:] = snapshots[1:, 2 * size : 3 * size]
    return np.asarray(batch.rollout(count, record=("sensordata",))["sensordata"])

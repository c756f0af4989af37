"""Canonical motion under rising noise: what a discriminator still takes for canonical.

The paper's picture of its discriminator (appendix 'Visualizations of the Discriminator'). Joints
move at different rates and scales, so that each number gets noise in proportion to its own
canonical standard deviation (appendix 'Improving GAN training').
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

NOISE_LEVELS = (0.0, *(float(f"{10 ** (k / 6 - 1):.3g}") for k in range(13)))
"""In canonical standard deviations, up to the 10 at which the paper's instance noise starts; evenly
spaced in logarithm from 0.1 on, where shares have moved by 0.03 at most (measured). Ours."""


def movement(canonical: Float[np.ndarray, "*batch f"]) -> Float[np.ndarray, " f"]:
    """Standard deviation of each feature; 0 for one that takes two values or fewer.

    Such a feature says which, as the one-hot itch does, and is no movement that could be noisy.

    Example:
        >>> movement(np.array([[0.0, 1.0], [3.0, 0.0], [6.0, 1.0]])).round(2)
        array([2.45, 0.  ])
    """
    rows = np.asarray(canonical, dtype=np.float64).reshape(-1, canonical.shape[-1])
    moves = np.array([len(np.unique(column)) > 2 for column in rows.T])
    return np.where(moves, rows.std(axis=0), 0.0)


def under_noise(
    episodes: Float[np.ndarray, "E T f"],
    deviation: Float[np.ndarray, " f"],
    rng: np.random.Generator,
    levels: Sequence[float] = NOISE_LEVELS,
) -> Float[np.ndarray, "L E T f"]:
    """Episodes with Gaussian noise of each level, independent from step to step.

    Every level scales the same draw, so that a pose drifts off along one line as noise rises.

    Args:
        episodes: Features in the task's own units.
        deviation: What a level of 1 means for each of them; see `movement`.
        rng: Consumed.
        levels: In units of `deviation`.
    """
    drift = rng.standard_normal(episodes.shape) * deviation
    return np.stack([episodes + level * drift for level in levels]).astype(np.float32)

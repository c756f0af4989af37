"""Gymnasium spaces of a policy's training, held against what the task's agent sees and does."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from jaxtyping import Shaped

from rigid.errors import UserError
from rigid.policies.foreign import Wanted
from rigid.policies.sb3_inputs import Statistics


def check_observation(
    space: Any, wanted: Wanted, frames: int, statistics: Statistics | None
) -> int:
    """Numbers of one of the observations that a policy sees.

    Raises:
        UserError: It sees no vector, or another number of frames than the user says.
    """
    if not isinstance(space, spaces.Box) or len(space.shape) != 1:
        raise UserError(
            f"{wanted.label} sees {_described(space)}, but the {wanted.agent} of "
            f"{wanted.task.name!r} sees a vector of {wanted.sizes.observation_size} numbers"
        )
    whole, size = space.shape[0], wanted.sizes.observation_size
    if whole % frames or (whole != frames * size and whole % size == 0):
        cure = f": say --frames {whole // size}" if whole % size == 0 else ""
        sees = f"{whole // size} × {size}" if whole % size == 0 else str(whole)
        raise UserError(f"{wanted.label} sees {sees} numbers, not {frames} × {size}{cure}")
    one = whole // frames
    if statistics is not None and len(statistics.mean) not in {one, whole}:
        raise UserError(
            f"--vecnormalize has statistics of {len(statistics.mean)} numbers, but {wanted.label} "
            f"sees {frames} × {one}: name the file of this policy"
        )
    return one


def from_space(action: Shaped[np.ndarray, "B ..."], space: Any) -> Shaped[np.ndarray, "B ..."]:
    """An action of the space as RIGID's tasks take it.

    Reals of a bounded Box are mapped to [-1, 1]; the numbers of choices stay what they are.

    Raises:
        UserError: No task has such actions.
    """
    if isinstance(space, spaces.Discrete | spaces.MultiDiscrete | spaces.MultiBinary):
        return action.astype(np.int64)  # From 0 on: Stable-Baselines3 adds no `start`.
    if not isinstance(space, spaces.Box):
        raise UserError(f"acts in {_described(space)}, but tasks take a Box or discrete actions")
    flat = action.reshape(len(action), -1).astype(np.float64)
    low, high = (bound.reshape(-1).astype(np.float64) for bound in (space.low, space.high))
    bounded = np.isfinite(low) & np.isfinite(high) & (high > low)
    width = np.where(bounded, high - low, 2.0)
    return np.where(bounded, 2.0 * (flat - np.where(bounded, low, 0.0)) / width - 1.0, flat)


def _described(space: Any) -> str:
    if isinstance(space, spaces.Dict):
        return f"a Dict of {', '.join(space.spaces)}"
    shape = getattr(space, "shape", None)
    return f"{type(space).__name__}{shape or ''}"

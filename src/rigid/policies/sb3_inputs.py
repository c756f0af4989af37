"""What stood between environment and policy in Stable-Baselines3: VecNormalize, VecFrameStack."""

from __future__ import annotations

import hashlib
import pickle
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Float32

from rigid.errors import UserError
from rigid.files import read_bytes
from rigid.policies.foreign import first_line

_PATTERN = "*vec*normalize*.pkl"
"""As RL Zoo (vecnormalize.pkl, in a folder beside the policy's file) and `CheckpointCallback`
(PREFIX_vecnormalize_STEPS_steps.pkl) name the statistics; vec_normalize.pkl is in SB3's guide."""


@dataclass(frozen=True)
class Statistics:
    """Frozen statistics of VecNormalize."""

    mean: Float[np.ndarray, " n"]
    variance: Float[np.ndarray, " n"]
    epsilon: float
    clip: float
    sha256: str
    """Of the file."""

    def normalise(self, observation: Float[np.ndarray, "B n"]) -> Float32[np.ndarray, "B n"]:
        """As `VecNormalize.normalize_obs`."""
        scaled = (observation - self.mean) / np.sqrt(self.variance + self.epsilon)
        clipped: np.ndarray = np.clip(scaled, -self.clip, self.clip)
        return clipped.astype(np.float32)


@dataclass(frozen=True)
class Inputs:
    """From the task's observations to what the policy sees.

    Statistics of one observation were taken before stacking (as RL Zoo wraps), those of a whole
    stack after it.
    """

    size: int
    """Numbers of one observation."""
    frames: int
    statistics: Statistics | None

    def start(self, batch: int) -> Float32[np.ndarray, "B past"]:
        """Frames before the first step: zeros, as VecFrameStack has them after a reset."""
        return np.zeros((batch, (self.frames - 1) * self.size), np.float32)

    def see(
        self, observation: Float[np.ndarray, "B o"], past: Float32[np.ndarray, "B past"]
    ) -> tuple[Float32[np.ndarray, "B n"], Float32[np.ndarray, "B past"]]:
        """What the policy sees, oldest frame first, and the frames to keep."""
        newest, statistics = observation.astype(np.float32), self.statistics
        before = statistics is not None and len(statistics.mean) == self.size
        if statistics is not None and before:
            newest = statistics.normalise(newest)
        whole = np.concatenate([past, newest], axis=1)
        seen = whole if statistics is None or before else statistics.normalise(whole)
        return seen, whole[:, self.size :]


def read_statistics(path: Path) -> Statistics | None:
    """What `VecNormalize.save(…)` wrote; None where it left observations as they were.

    The file is a pickle: only for users who trust it.

    Raises:
        UserError: It is missing or damaged, or something else.
    """
    data = read_bytes(path, cure="name a file that VecNormalize.save(…) wrote")
    try:
        found: Any = pickle.loads(data)  # noqa: S301 - The user said --trust.
        if not found.norm_obs:
            return None
        moments = found.obs_rms
        return Statistics(
            np.asarray(moments.mean, np.float64), np.asarray(moments.var, np.float64),
            float(found.epsilon), float(found.clip_obs), hashlib.sha256(data).hexdigest(),
        )  # fmt: skip
    except Exception as error:  # noqa: BLE001 - Pickles may raise anything.
        raise UserError(
            f"{path} holds no statistics of VecNormalize ({first_line(error)}): name a "
            "file that env.save(…) wrote"
        ) from None


def statistics_beside(path: Path) -> list[Path]:
    """Files near a policy's that look like statistics of VecNormalize."""
    folders = [path.parent, *(entry for entry in path.parent.iterdir() if entry.is_dir())]
    return sorted(found for folder in folders for found in folder.glob(_PATTERN))

"""What is fixed before the first participant: margin, levels and the budget of the models."""

from __future__ import annotations

import hashlib
from dataclasses import asdict, dataclass
from typing import Any

from rigid.errors import UserError
from rigid.files import json_text

METHOD = 1
"""Raised whenever equal data and settings would give other numbers: part of what is registered."""


@dataclass(frozen=True, kw_only=True)
class AnalysisSettings:
    """Choices of the analysis; a study registers their hash before anybody takes part."""

    margin: float = 0.1
    """How far from one half a preference may lie and still count as none. Ours: people who judge
    motions of one naturalness choose either one, but for one in ten."""
    confidence: float = 0.95
    """Of intervals; tests have size 1 - confidence."""
    benign_floor: float = 0.5
    """Naturalness of benign players below which nothing is claimed of their device: most of what
    the referee sees there is then the device. Ours."""
    episode_quantile: float = 0.95
    """Quantile of an adversary's episodes that a person's episode is held against. Ours."""
    permutations: int = 20_000
    """Draws where the permutations are too many to go through all of them."""
    chains: int = 4
    """Markov chains of a mixed model; R-hat needs several."""
    samples: int = 1500
    """Of each chain, after as many to warm up; three times as many where that is not enough."""
    seed: int = 0

    def __post_init__(self) -> None:
        if not 0.0 < self.margin < 0.5:
            raise UserError(
                f"--margin is {self.margin:g}, but a preference lies between 0 and 1 and no "
                "preference is one half: choose a margin above 0 and below 0.5, as in 0.1"
            )

    def describe(self) -> dict[str, Any]:
        """All of it as JSON, with the number of the method."""
        return {"method": METHOD, **asdict(self)}


def analysis_hash(settings: AnalysisSettings | None = None) -> str:
    """SHA-256 of the settings and the number of the method, for registration.

    Args:
        settings: By default those of `rigid study analyze` without options.
    """
    return hashlib.sha256(
        json_text((settings or AnalysisSettings()).describe()).encode()
    ).hexdigest()

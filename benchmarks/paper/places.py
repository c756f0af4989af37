"""Where everything lies: raw trainings and runs in one place, what is kept of them in another."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Places:
    """Paths of the experiments; `name` is a recipe or a variant of one."""

    out: Path
    results: Path

    def pair(self, seed: int) -> Path:
        """The co-optimised pair of a robot seed."""
        return self.out / f"seed-{seed}" / "pair"

    def human(self, seed: int) -> Path:
        """The synthetic human of a robot seed."""
        return self.pair(seed) / "human"

    def robot(self, name: str, seed: int) -> Path:
        """A robot's directory."""
        return self.out / f"seed-{seed}" / name

    def run(self, name: str, seed: int) -> Path:
        """A robot's frontier, raw."""
        return self.out / f"seed-{seed}" / "runs" / name

    def kept_policy(self, name: str, seed: int) -> Path:
        """A policy as it is kept."""
        return self.results / "robots" / f"seed-{seed}" / name

    def kept_run(self, name: str, seed: int) -> Path:
        """A frontier as it is kept."""
        return self.results / "runs" / f"seed-{seed}" / name

    def kept_part(self, name: str) -> Path:
        """Numbers of another kind."""
        return self.results / "parts" / f"{name}.json"

"""What is measured how often, and how far two measurements may lie apart."""

from __future__ import annotations

from dataclasses import dataclass

from rigid.errors import UserError
from rigid.presets import Preset
from rigid.tasks.protocol import Task

NUMBERS = ("worst_at", "auc_natural", "auc")
LIMITS = {"worst_at": 0.06, "auc": 0.03}
"""Largest difference between two measurements that still counts as the same number. Fixed before
the first measurement; ours."""
LIMIT_SHARE = 0.9
"""Share of pairs that must keep a limit. Ours."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """One run of the study."""

    task: Task
    robot: str
    preset: Preset
    measurements: int = 6
    command: str = "python -m benchmarks.reliability"
    stamp: str = ""
    """Printed on the account."""

    def __post_init__(self) -> None:
        """Refuses what has no spread.

        Raises:
            UserError: There are fewer than two measurements, or fewer than two seeds in each.
        """
        if self.measurements < 2:
            raise UserError(f"--measurements is {self.measurements}, but a pair needs 2")
        if len(self.preset.seeds) < 2:
            raise UserError(
                f"preset {self.preset.name!r} has one search seed, which predicts no spread: "
                "choose another with --preset"
            )

    def seeds(self, measurement: int) -> tuple[int, ...]:
        """Search seeds of measurement 1, 2, …: as many as the preset's, in no other one.

        The first ones, 0 and on, are left to ordinary measurements.
        """
        count = len(self.preset.seeds)
        return tuple(range(measurement * count, (measurement + 1) * count))

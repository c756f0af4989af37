"""Everything about bed bathing that a study may vary, with the source of each number."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from rigid.tasks.physics.parameters import Simulated, Weights


@dataclass(frozen=True, kw_only=True)
class RewardWeights(Weights):
    """Weights of the reward terms, all Assistive Gym's."""

    distance: float = 1.0
    """Per metre between pad and arm."""
    wipe: float = 5.0
    """Per point that is wiped."""
    other_force: float = 0.01
    """Per newton on the person, but for that of the pad on the arm."""


@dataclass(frozen=True, kw_only=True)
class BedBathingParameters(Simulated):
    """Body, impairment and physics of one bed-bathing task."""

    task: ClassVar[str] = "bed-bathing"
    full_tremor_deg: ClassVar[float] = 10.0  # Assistive Gym.

    arm_start_deg: float = 5.7
    """The arm starts turned by up to this angle about each joint that does not lift it off the bed
    or press it in, in [0, 10] (Assistive Gym: 0.1 rad about every joint before the person settles
    on the bed); within the joint's limits."""
    weights: RewardWeights = field(default_factory=RewardWeights)

    def check(self) -> None:
        """Checks how the arm starts."""
        self.require(0 <= self.arm_start_deg <= 10, "arm_start_deg", "in [0, 10]")

"""Everything about feeding that a study may vary, with the source of each number."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from rigid.tasks.physics.parameters import Simulated, Weights


@dataclass(frozen=True, kw_only=True)
class RewardWeights(Weights):
    """Weights of the reward terms, all Assistive Gym's."""

    distance: float = 1.0
    """Per metre between spoon and mouth."""
    food: float = 20.0
    """Per piece of food that reaches the mouth."""
    spill: float = 5.0
    """Per piece that falls off the spoon."""
    food_hit: float = 1.0
    """Per piece that falls on the person."""
    food_speed: float = 1.0
    """Per m/s of each piece as it reaches the mouth."""
    force: float = 0.01
    """Per newton of robot and spoon on the person."""


@dataclass(frozen=True, kw_only=True)
class FeedingParameters(Simulated):
    """Body, impairment and physics of one feeding task."""

    task: ClassVar[str] = "feeding"
    full_tremor_deg: ClassVar[float] = 20.0  # Assistive Gym, where the head moves.

    head_start_deg: float = 30.0
    """The head starts turned about each of its axes by up to this angle, in [0, 30] (Assistive
    Gym: 30); within the joint's limits."""
    weights: RewardWeights = field(default_factory=RewardWeights)

    def check(self) -> None:
        """Checks how the head starts."""
        self.require(0 <= self.head_start_deg <= 30, "head_start_deg", "in [0, 30]")

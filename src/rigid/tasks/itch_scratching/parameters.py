"""Everything about itch scratching that a study may vary, with the source of each number."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

from rigid.tasks.physics.parameters import Simulated, Weights


@dataclass(frozen=True, kw_only=True)
class RewardWeights(Weights):
    """Weights of the reward terms.

    Assistive Gym's values, but for `distance` and `unwanted_contact`: the paper raises the first
    and adds the second (appendix, 'Additional Details of the Environment Setup') without numbers.
    """

    distance: float = 3.0
    """Per metre between tip and itch. Ours: three times Assistive Gym's 1.0."""
    scratch: float = 5.0
    """Per counted contact (Assistive Gym)."""
    other_force: float = 0.01
    """Per newton on the person away from the itch (Assistive Gym)."""
    unwanted_contact: float = 2.0
    """Per step in which the robot touches the person anywhere but on the arms. Ours."""


@dataclass(frozen=True, kw_only=True)
class ItchScratchingParameters(Simulated):
    """Body, impairment, itch and physics of one itch-scratching task."""

    task: ClassVar[str] = "itch-scratching"
    full_tremor_deg: ClassVar[float] = 10.0  # Assistive Gym.

    itch_limbs: tuple[Literal["forearm", "upper_arm"], ...] = ("forearm", "upper_arm")
    """Where it can itch: the middle of each named limb (paper: two fixed points)."""
    itch_spread: float = 0.0
    """Share of each limb's half length, in [0, 1], over which the itch of an episode is drawn, to
    either side of the middle; 1: anywhere along the limb (paper, appendix 'PALM': anywhere on the
    two arms. Ours has one arm that moves, so both of its limbs take the place of two arms)."""
    weights: RewardWeights = field(default_factory=RewardWeights)

    def check(self) -> None:
        """Checks where it itches."""
        limbs = ("forearm", "upper_arm")
        known = bool(self.itch_limbs) and set(self.itch_limbs) <= set(limbs)
        self.require(known, "itch_limbs", f"one or both of {limbs}")
        self.require(0 <= self.itch_spread <= 1, "itch_spread", "in [0, 1]")

    def describe(self) -> dict[str, Any]:
        """As JSON; what came after the first release only where it departs from its default.

        So older runs, policies and episodes keep their identity.
        """
        described = super().describe()
        if self.itch_spread == 0:
            del described["itch_spread"]
        return described

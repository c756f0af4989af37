"""Everything about itch scratching that a study may vary, with the source of each number."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from functools import partial
from math import inf
from typing import Any, Literal

from rigid.tasks.bodies.person import Person, require

_require = partial(require, "itch-scratching")


@dataclass(frozen=True, kw_only=True)
class RewardWeights:
    """Weights of the reward terms; the reward is shared by robot and human.

    Assistive Gym's values, but for `distance` and `unwanted_contact`: the paper raises the first
    and adds the second (appendix, 'Additional Details of the Environment Setup') without numbers.
    """

    distance: float = 3.0
    """Per metre between tip and itch. Ours: three times Assistive Gym's 1.0."""
    scratch: float = 5.0
    """Per counted contact (Assistive Gym)."""
    action: float = 0.01
    """Per unit of the joint action's 2-norm (Assistive Gym)."""
    velocity: float = 0.25
    """Per m/s of the end effector (Assistive Gym)."""
    other_force: float = 0.01
    """Per newton on the person away from the itch (Assistive Gym)."""
    high_force: float = 0.05
    """Per newton at the itch from 10 N on (Assistive Gym)."""
    unwanted_contact: float = 2.0
    """Per step in which the robot touches the person anywhere but on the arms. Ours."""


@dataclass(frozen=True, kw_only=True)
class ItchScratchingParameters(Person):
    """Body, impairment, itch and physics of one itch-scratching task."""

    itch_limbs: tuple[Literal["forearm", "upper_arm"], ...] = ("forearm", "upper_arm")
    """Where it can itch: the middle of each named limb (paper: two fixed points)."""
    itch_spread: float = 0.0
    """Share of each limb's half length, in [0, 1], over which the itch of an episode is drawn, to
    either side of the middle; 1: anywhere along the limb (paper, appendix 'PALM': anywhere on the
    two arms. Ours has one arm that moves, so both of its limbs take the place of two arms)."""
    servo: Literal["paper", "datasheet"] = "paper"
    """Torque caps of the arm: 1 N·m on every joint as in the original (its forces are unlike
    those of a real arm) or Kinova's data sheet."""
    weights: RewardWeights = field(default_factory=RewardWeights)
    horizon: int = 100
    """Control steps of an episode (paper, appendix B)."""
    physics_step: float = 0.02
    """[s], as the original."""
    substeps: int = 5
    """Physics steps in a control step: 10 Hz (the original)."""

    def __post_init__(self) -> None:
        """Checks every value; raises `UserError` naming the bad one."""
        self.check_person("itch-scratching")
        limbs = ("forearm", "upper_arm")
        known = bool(self.itch_limbs) and set(self.itch_limbs) <= set(limbs)
        _require(known, "itch_limbs", self.itch_limbs, f"one or both of {limbs}")
        _require(0 <= self.itch_spread <= 1, "itch_spread", self.itch_spread, "in [0, 1]")
        _require(self.servo in ("paper", "datasheet"), "servo", self.servo, "paper or datasheet")
        _require(self.horizon >= 1, "horizon", self.horizon, "at least 1 step")
        _require(0 < self.physics_step <= 0.02, "physics_step", self.physics_step, "in (0, 0.02] s")
        _require(self.substeps >= 1, "substeps", self.substeps, "at least 1")

        for name, weight in asdict(self.weights).items():
            _require(0 <= weight < inf, f"weights.{name}", weight, "a number from 0 on")

    def describe(self) -> dict[str, Any]:
        """As JSON; what came after the first release only where it departs from its default.

        So older runs, policies and episodes keep their identity.
        """
        described = asdict(self)
        if self.itch_spread == 0:
            del described["itch_spread"]
        return described

    @property
    def tremor_deg(self) -> float:
        """Amplitude of the tremor [deg], at most ±10° (Assistive Gym); flips every control step."""
        return 10.0 * self.severity if self.impairment == "tremor" else 0.0

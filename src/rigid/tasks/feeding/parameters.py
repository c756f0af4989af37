"""Everything about feeding that a study may vary, with the source of each number."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from functools import partial
from math import inf
from typing import Any, Literal

from rigid.tasks.bodies.person import Person, require

_require = partial(require, "feeding")


@dataclass(frozen=True, kw_only=True)
class RewardWeights:
    """Weights of the reward terms, all Assistive Gym's; the reward is shared by robot and human."""

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
    action: float = 0.01
    """Per unit of the joint action's 2-norm."""
    velocity: float = 0.25
    """Per m/s of the end effector."""
    force: float = 0.01
    """Per newton of robot and spoon on the person."""
    high_force: float = 0.05
    """Per newton of the spoon on the person from 10 N on."""


@dataclass(frozen=True, kw_only=True)
class FeedingParameters(Person):
    """Body, impairment and physics of one feeding task."""

    head_start_deg: float = 30.0
    """The head starts turned about each of its axes by up to this angle, in [0, 30] (Assistive
    Gym: 30); within the joint's limits."""
    servo: Literal["paper", "datasheet"] = "paper"
    """Torque caps of the arm: 1 N·m on every joint as in the original (its forces are unlike
    those of a real arm) or Kinova's data sheet."""
    weights: RewardWeights = field(default_factory=RewardWeights)
    horizon: int = 100
    """Control steps of an episode. Ours, that of itch scratching (the original has 200)."""
    physics_step: float = 0.02
    """[s], as the original."""
    substeps: int = 5
    """Physics steps in a control step: 10 Hz (the original)."""

    def __post_init__(self) -> None:
        """Checks every value; raises `UserError` naming the bad one."""
        self.check_person("feeding")
        start = self.head_start_deg
        _require(0 <= start <= 30, "head_start_deg", start, "in [0, 30]")
        _require(self.servo in ("paper", "datasheet"), "servo", self.servo, "paper or datasheet")
        _require(self.horizon >= 1, "horizon", self.horizon, "at least 1 step")
        _require(0 < self.physics_step <= 0.02, "physics_step", self.physics_step, "in (0, 0.02] s")
        _require(self.substeps >= 1, "substeps", self.substeps, "at least 1")
        for name, weight in asdict(self.weights).items():
            _require(0 <= weight < inf, f"weights.{name}", weight, "a number from 0 on")

    def describe(self) -> dict[str, Any]:
        """As JSON."""
        return asdict(self)

    @property
    def tremor_deg(self) -> float:
        """Amplitude of the tremor [deg], at most ±20° (Assistive Gym, where the head moves)."""
        return 20.0 * self.severity if self.impairment == "tremor" else 0.0

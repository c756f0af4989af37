"""What a study may vary of every task on MuJoCo: person, reward, the arm's motors, and time."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from math import inf
from typing import Any, ClassVar, Literal, TypeVar

from rigid.tasks.bodies.person import Person, require
from rigid.tasks.physics.again import fine_steps


@dataclass(frozen=True, kw_only=True)
class Weights:
    """Weights of reward terms, numbers from 0 on; the reward is shared by robot and human.

    These three are Assistive Gym's in every task.
    """

    action: float = 0.01
    """Per unit of the joint action's 2-norm."""
    velocity: float = 0.25
    """Per m/s of the end effector."""
    high_force: float = 0.05
    """Per newton of the tool where it belongs, from 10 N on."""


@dataclass(frozen=True, kw_only=True)
class Simulated(Person):
    """Person, reward and physics of one task.

    A task names itself, adds its own fields, and checks them in `check`.
    """

    task: ClassVar[str]
    """Name of the task, for messages."""
    full_tremor_deg: ClassVar[float]
    """Amplitude of the severest tremor [deg]."""

    servo: Literal["paper", "datasheet"] = "paper"
    """Torque caps of the arm: 1 N·m on every joint as in the original (its forces are unlike
    those of a real arm) or Kinova's data sheet."""
    weights: Weights = field(default_factory=Weights)
    horizon: int = 100
    """Control steps of an episode (paper, appendix B, for itch scratching). Ours in other tasks."""
    physics_step: float = 0.02
    """[s], as the original."""
    substeps: int = 5
    """Physics steps in a control step: 10 Hz (the original)."""

    def __post_init__(self) -> None:
        """Checks every value; raises `UserError` naming the bad one."""
        self.check_person(self.task)
        step = self.physics_step
        self.require(self.servo in ("paper", "datasheet"), "servo", "paper or datasheet")
        self.require(self.horizon >= 1, "horizon", "at least 1 step")
        self.require(0 < step <= 0.02, "physics_step", "in (0, 0.02] s")
        self.require(self.substeps >= 1, "substeps", "at least 1")
        for name, weight in asdict(self.weights).items():
            allowed = "a number from 0 on"
            require(self.task, 0 <= weight < inf, f"weights.{name}", weight, allowed)
        self.check()

    def check(self) -> None:
        """Checks the fields that a task adds; raises `UserError` naming the bad one."""

    def require(self, condition: bool, name: str, allowed: str) -> None:
        """Raises `UserError` about the value of the field `name` unless `condition` holds."""
        require(self.task, condition, name, getattr(self, name), allowed)

    def describe(self) -> dict[str, Any]:
        """As JSON."""
        return asdict(self)

    @property
    def control_period(self) -> float:
        """Length of a control step [s]."""
        return self.physics_step * self.substeps

    @property
    def tremor_deg(self) -> float:
        """Amplitude of the tremor [deg]; it flips every control step."""
        return self.full_tremor_deg * self.severity if self.impairment == "tremor" else 0.0


P = TypeVar("P", bound=Simulated)


def finely(parameters: P) -> P:
    """The same with physics steps so short that people may look at the forces."""
    step, count = fine_steps(parameters.control_period)
    return replace(parameters, physics_step=step, substeps=count)

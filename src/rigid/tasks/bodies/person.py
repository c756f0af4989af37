"""Who sits in the chair: body and impairment, as far as a study may vary them in any task."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist
from typing import Literal

from rigid.errors import UserError
from rigid.tasks.bodies.sizes import BODIES, BodySize

Impairment = Literal["none", "limits", "weakness", "tremor"]

# Stature, mean and standard deviation [m]: ANSUR II (2012), U.S. Army men and women.
_STATURE = {"male": (1.756, 0.0686), "female": (1.629, 0.0642)}


@dataclass(frozen=True, kw_only=True)
class Person:
    """Body and impairment of one task's person."""

    body: Literal["male", "female"] = "male"
    """Which capsule body sits in the chair. The original draws it anew in every episode; a fixed
    body keeps naturalness a property of the motion."""
    percentile: float = 50.0
    """Stature percentile of that body, in [5, 95]; radii and mass follow stature."""
    impairment: Impairment = "none"
    severity: float = 1.0
    """Share of the impairment's full strength, in [0, 1]. Full strength is Assistive Gym's worst
    draw: joint range halved, strength a quarter, tremor of the task's `tremor_deg`."""

    def check_person(self, task: str) -> None:
        """Checks every value of a person in `task`; raises `UserError` naming the bad one."""
        require(task, self.body in BODIES, "body", self.body, f"one of {sorted(BODIES)}")
        require(task, 5 <= self.percentile <= 95, "percentile", self.percentile, "in [5, 95]")
        require(task, 0 <= self.severity <= 1, "severity", self.severity, "in [0, 1]")
        kinds = ("none", "limits", "weakness", "tremor")
        require(task, self.impairment in kinds, "impairment", self.impairment, f"one of {kinds}")

    @property
    def body_size(self) -> BodySize:
        """The body at the chosen percentile; girth follows stature to the power 1/2 (ours)."""
        mean, deviation = _STATURE[self.body]
        quantile = NormalDist().inv_cdf(self.percentile / 100)
        stature = 1 + quantile * deviation / mean
        return BODIES[self.body].scaled(stature, stature**0.5)

    @property
    def limit_scale(self) -> float:
        """Factor on the range of the joints that move."""
        return 1 - 0.5 * self.severity if self.impairment == "limits" else 1.0

    @property
    def strength(self) -> float:
        """Factor on their torque caps. In the original it weakens only a passive human."""
        return 1 - 0.75 * self.severity if self.impairment == "weakness" else 1.0


def require(task: str, condition: bool, name: str, value: object, allowed: str) -> None:
    """Raises `UserError` about a bad parameter unless `condition` holds."""
    if not condition:
        raise UserError(f"{task}: {name} is {value!r}, but must be {allowed}")

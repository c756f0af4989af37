"""The whole of `rigid verify`: which comparisons are made, at what effort, and what they say."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from rigid.compute.listening import Workload
from rigid.compute.verification import areas, cases, tracking
from rigid.compute.verification.cases import Advance, Case
from rigid.compute.verification.resting import Effort

AREA_SEEDS = (0, 1)
"""Three robots with seven λ each: two searches place the hull within .01. Ours."""
_JUDGING = 1.6
"""Time of everything over that of training, for the estimate only."""


@dataclass(frozen=True)
class Plan:
    """What will be compared."""

    cases: tuple[Case, ...]
    effort: Effort
    whole: bool
    """Whether areas and hand tracking are part of it."""

    @property
    def env_steps(self) -> int:
        """Training steps in all."""
        steps = cases.env_steps(self.cases, self.effort)
        if self.whole:
            steps += areas.env_steps(_for_areas(self.effort))
            steps += tracking.env_steps(self.effort)
        return steps

    def workload(self) -> Workload:
        """What lies ahead; its speed is that of a few iterations of each case."""
        total = sum(
            cases.seconds_per_step(case, self.effort) * cases.env_steps((case,), self.effort)
            for case in self.cases
        )
        seconds = _JUDGING * (2 if self.whole else 1) * total
        steps = self.env_steps
        return Workload(training_steps=steps, steps=steps, steps_per_second=steps / seconds)

    def run(self, advance: Advance, say: Callable[[str], None]) -> dict[str, Any]:
        """Makes the comparisons.

        Returns:
            JSON: `rows`, `areas`, `tracking`, and `ok`, whether all of them agree.
        """
        rows: list[dict[str, Any]] = []
        for case in self.cases:
            seeds = len(cases.seeds_of(case, self.effort))
            say(f"{case.setting}: {len(case.lambdas)} λ, {seeds} seeds")
            rows += cases.rows_of(case, self.effort, advance)
        under: list[dict[str, Any]] = []
        tracked: list[dict[str, Any]] = []
        if self.whole:
            for tolerance in areas.TOLERANCES:
                say(f"area under the frontier of a robot that catches up to {tolerance:g}")
                under += areas.areas(tolerance, _for_areas(self.effort), advance)
            say("hand tracking")
            tracked = tracking.rows(self.effort, advance)
        found = {"rows": rows, "areas": under, "tracking": tracked}
        return {**found, "ok": all(row["ok"] for part in found.values() for row in part)}


def plan_verification(lambdas: Sequence[float] | None = None, effort: Effort | None = None) -> Plan:
    """Everything by default; only the given λ of the default penalty, and `paper_d2`, otherwise.

    Raises:
        UserError: A λ has no optimum.
    """
    chosen = cases.cases(cases.LAMBDAS if lambdas is None else lambdas)
    return Plan(chosen, effort or Effort(), whole=lambdas is None)


def _for_areas(effort: Effort) -> Effort:
    """Fewer seeds, and larger steps: λ = 0 has to get far beyond the robot's tolerance."""
    ppo = replace(effort.ppo, learning_rate=5e-3)
    return replace(effort, seeds=effort.seeds[: len(AREA_SEEDS)], ppo=ppo)

"""Step 3 of the paper: the two ends of the search, before anything between is believed.

"Experiment with λ=0 to ensure that a purely adversarial human policy can be learned. Experiment
with λ=∞ to ensure that a natural human policy that stays close to the canonical dataset can be
learned."
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from rigid.doctor.noise import DEVIATIONS, deviations_below, mean_and_error
from rigid.doctor.verdict import Verdict

_NATURAL, _TOLERABLE = 0.7, 0.5
"""Naturalness of λ = ∞: the referee's gate for the largest λ, and half-way to it. Ours."""
_BROKEN = 0.5
"""λ = 0 breaks a task that it leaves at most this share of the canonical successes. Ours."""

_HELPED = 0.5
"""Canonical success below which a robot is hardly worth measuring. Ours."""


@dataclass(frozen=True)
class End:
    """The adversaries of one λ, or canonical play."""

    returns: Sequence[Float[np.ndarray, " _n"]]
    """Of each seed's."""
    success: float | None
    """Mean; None where the task defines none."""
    naturalness: Sequence[float] = ()
    """Of each seed's."""


def check_ends(canonical: End, sabotage: End, natural: End) -> Verdict:
    """Whether λ = 0 breaks the task and λ = ∞ stays canonical."""
    x = float(np.mean(natural.naturalness))
    low, high = mean_and_error(sabotage.returns)[0], mean_and_error(canonical.returns)[0]
    evidence = {
        "sabotage": _described(sabotage), "natural": _described(natural),
        "canonical": _described(canonical), "natural_at_least": _NATURAL,
    }  # fmt: skip
    stays = f"λ = ∞ keeps a naturalness of {x:.2f}"
    if deviations_below(sabotage.returns, canonical.returns[0]) < DEVIATIONS:
        return Verdict(
            "ends", "fail", f"λ = 0 does not break the task: it earns {low:.4g}, canonical play "
            f"{high:.4g}; {stays}.", "See the step on the reward.", evidence,
        )  # fmt: skip
    if x < _NATURAL:
        return _unnatural(x, stays, evidence)
    how = _how_broken(canonical, sabotage)
    if how is None:
        return Verdict(
            "ends", "warn",
            f"λ = 0 weakens the task ({high:.4g} to {low:.4g}) and does not break it; {stays}.",
            "Search longer (--budget here, --preset paper later); else the robot is robust to any "
            "human, or humans can do little in this task.", evidence,
        )  # fmt: skip
    if canonical.success is not None and canonical.success < _HELPED:
        return Verdict(
            "ends", "warn",
            f"Both ends are where they should be, but canonical play itself succeeds only in "
            f"{canonical.success:.0%} of the episodes.",
            "Train the robot and its human longer before you measure: what cannot help has little "
            "to lose.", evidence,
        )  # fmt: skip
    return Verdict("ends", "pass", f"λ = 0 breaks the task ({how}), and {stays}.", "", evidence)


def _unnatural(x: float, stays: str, evidence: Mapping[str, object]) -> Verdict:
    """λ = ∞ leaves what is canonical."""
    if x < _TOLERABLE:
        return Verdict(
            "ends", "fail",
            f"{stays}: an adversary that is paid for naturalness alone does not look canonical.",
            "Leave out features that no policy can imitate (--features), record more canonical "
            "episodes, or give adversaries a memory if what is natural depends on the past.",
            evidence,
        )  # fmt: skip
    return Verdict(
        "ends", "warn", f"{stays}, less than {_NATURAL:g}: the natural end of the curve is "
        "out of reach.", "Search longer (--budget here, --preset paper later), or record more "
        "canonical episodes.", evidence,
    )  # fmt: skip


def _how_broken(canonical: End, sabotage: End) -> str | None:
    """In which way λ = 0 breaks the task, None where it does not."""
    if canonical.success and sabotage.success is not None:
        if sabotage.success <= _BROKEN * canonical.success:
            return f"success {sabotage.success:.2f} instead of {canonical.success:.2f}"
        return None
    rare = float(np.quantile(canonical.returns[0], 0.05))
    low = mean_and_error(sabotage.returns)[0]
    return f"return {low:.4g}, canonical 5 % {rare:.4g}" if low < rare else None


def _described(end: End) -> dict[str, object]:
    return {
        "return": mean_and_error(end.returns)[0],
        "success": end.success,
        "naturalness": list(end.naturalness),
    }

"""Step 4 of the paper, a first time and coarsely: scan over λ, and look at the curve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from rigid.doctor.verdict import Verdict

_JUMP = 0.6
"""Share of the whole rise in naturalness that one step of λ may take before it is a jump. Ours."""
_RISE = 0.2
"""Rise in naturalness from λ = 0 to ∞ below which there is no curve. Ours."""


def check_scan(
    naturalness: Mapping[float, Sequence[float]], harm: Mapping[float, float]
) -> Verdict:
    """Whether naturalness rises gradually with λ.

    Args:
        naturalness: By λ, of each seed's adversary; inf is allowed.
        harm: By λ, the share of the harm of λ = 0 that is done.
    """
    lambdas = sorted(naturalness)
    means = np.array([np.mean(naturalness[value]) for value in lambdas])
    rising = np.maximum.accumulate(means)  # Noise may take a step back.
    names = [_text(value) for value in lambdas]
    evidence = {
        "lambdas": names,
        "naturalness": [list(map(float, naturalness[value])) for value in lambdas],
        "harm": [float(harm[value]) for value in lambdas],
    }
    rise = float(rising[-1] - rising[0])
    if rise < _RISE:
        return Verdict(
            "scan", "warn",
            f"Naturalness rises by {rise:.2f} only from λ = 0 to λ = ∞: there is no curve yet.",
            "See the steps before; if they pass, scan a wider range with --lambdas.",
            evidence,
        )  # fmt: skip
    steps = np.diff(rising)
    place = int(np.argmax(steps))
    low, high = list(pairwise(names))[place]
    if steps[place] > _JUMP * rise:
        return Verdict(
            "scan", "warn",
            f"Naturalness jumps from {rising[place]:.2f} to {rising[place + 1]:.2f} between "
            f"λ = {low} and λ = {high}.",
            "The search refines there by itself (Algorithm 1): give it its rounds with --preset "
            "paper, or name λ between the two with --lambdas.",
            evidence,
        )  # fmt: skip
    between = int(((rising > rising[0] + 0.1 * rise) & (rising < rising[-1] - 0.1 * rise)).sum())
    return Verdict(
        "scan", "pass",
        f"Naturalness rises from {rising[0]:.2f} to {rising[-1]:.2f} with λ, gradually: {between} "
        f"of {len(lambdas)} λ lie between the ends.", "", evidence,
    )  # fmt: skip


def _text(lambda_: float) -> str:
    return "∞" if np.isinf(lambda_) else f"{lambda_:g}"

"""Exact answers for offset catch: canonical N(0, 1) against adversaries N(m, 1).

p denotes the canonical density, q the adversary's, κ the class weight of canonical samples (paper:
4), r = q/p, and s = r / (r + κ) the share of weighted mass that is the adversary's; the optimal
discriminator is D = 2s - 1. Derivations: `docs/analytic.md`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq, minimize_scalar
from scipy.special import expit
from scipy.stats import norm

Penalty = Literal["amp", "paper_d2"]

_SLOPES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "amp": lambda s: 2 * s,  # ¼ (D + 1)² = s²
    "paper_d2": lambda s: 4 * (2 * s - 1),  # D² = (2s - 1)²
}
"""dφ/ds of each penalty, written here once more: a mistake in the product must not move both."""

_GRID = np.linspace(-10.0, 10.0, 4001)  # Of quadratures [canonical deviations].
_FARTHEST = 7.0  # No shift beyond it is looked for: the force is gone by then.


def log_ratio(offset: Float[np.ndarray, "*n"], shift: float) -> Float[np.ndarray, "*n"]:
    """Log-ratio log q/p = m x - m²/2."""
    return np.asarray(shift * offset - shift**2 / 2)


def best_score(
    offset: Float[np.ndarray, "*n"], shift: float, kappa: float
) -> Float[np.ndarray, "*n"]:
    """Score of the optimal discriminator, (r - κ) / (r + κ)."""
    return np.asarray(np.tanh((log_ratio(offset, shift) - np.log(kappa)) / 2))


def naturalness(shift: float, kappa: float = 4.0) -> float:
    """N_κ = P_q[D < 0] = Φ(log κ / m - m / 2), the share of adversarial play with q < κ p.

    Example:
        >>> round(naturalness(1.0), 5)
        0.81227
    """
    size = abs(shift)
    if size == 0:  # r = 1 everywhere: natural if that is below κ.
        return float(kappa > 1)
    return float(norm.cdf(np.log(kappa) / size - size / 2))


def overlap(shift: float, kappa: float = 4.0) -> float:
    """∫ min(q, κ p) = N_κ + κ Φ(-log κ / m - m / 2), what the referee estimates.

    Example:
        >>> round(overlap(1.0), 4)
        0.9308
    """
    size = abs(shift)
    if size == 0:
        return float(min(1.0, kappa))
    return naturalness(shift, kappa) + kappa * float(norm.cdf(-np.log(kappa) / size - size / 2))


def restoring_force(shift: float, penalty: Penalty = "amp", kappa: float = 4.0) -> float:
    """G(m) = E_q[dφ/dx], how fast the frozen penalty grows as the adversary shifts further.

    Policy gradients move q while the discriminator stands still, so this, not the slope of
    E_q[φ] along the family, is what the adversary feels.
    """
    s = expit(log_ratio(_GRID, shift) - np.log(kappa))
    slope = _SLOPES[penalty](s) * s * (1 - s) * shift
    return float(np.trapezoid(norm.pdf(_GRID, shift) * slope, _GRID))


def optimal_shift(
    lambda_: float, penalty: Penalty = "amp", kappa: float = 4.0, slope: float = 1.0
) -> float:
    """Shift m > 0 at which an adversary with cost `slope`·x comes to rest: slope = λ G(m).

    Args:
        lambda_: Weight of the penalty; inf gives the root of G that attracts.
        penalty: Which one.
        kappa: Class weight.
        slope: b, cost per unit of offset.

    Raises:
        ValueError: λ is not above `smallest_lambda`: the adversary runs away.

    Example:
        >>> round(optimal_shift(6.0), 4), round(optimal_shift(20.0, "paper_d2"), 4)
        (1.1347, 1.8118)
    """
    peak, force = _strongest(penalty, kappa)
    wanted = slope / lambda_
    if not wanted < force:
        raise ValueError(f"lambda_ is {lambda_}, but must be more than {slope / force:.3f}")
    # Below its stable rest the force is too weak to stop the shift; from there to the peak it is
    # not. Where D² pushes outwards (κ > 1, small m) there is no rest.
    inner = 0.0 if penalty == "amp" or kappa <= 1 else np.sqrt(2 * np.log(kappa)) - 1e-9
    if wanted == 0:
        return float(inner)
    return float(
        brentq(lambda m: restoring_force(m, penalty, kappa) - wanted, inner, peak, xtol=1e-10)
    )


def smallest_lambda(penalty: Penalty = "amp", kappa: float = 4.0, slope: float = 1.0) -> float:
    """λ below which a bounded penalty holds nothing: slope / max G.

    Example:
        >>> round(smallest_lambda(), 3), round(smallest_lambda(kappa=1.0), 3)
        (2.992, 3.388)
    """
    return slope / _strongest(penalty, kappa)[1]


def kl_shift(lambda_: float, slope: float = 1.0) -> float:
    """Shift under the penalty λ KL(q‖p): the tilt p e^{c/λ} shifts by m = slope / λ."""
    return slope / lambda_


def failure(shift: float, tolerance: float) -> float:
    """Adversarialness with cost `failure`: P_q[x > tolerance] = Φ(m - t)."""
    return float(norm.cdf(shift - tolerance))


def family(
    tolerance: float,
    axis: Callable[[float, float], float] = naturalness,
    kappa: float = 4.0,
    points: int = 2000,
) -> Float[np.ndarray, "n 2"]:
    """The frontier of all mean shifts, (naturalness, adversarialness), canonical play included."""
    shifts = np.linspace(0.0, REACH_OF_FAMILY, points)
    return np.array([(axis(float(m), kappa), failure(float(m), tolerance)) for m in shifts])


REACH_OF_FAMILY = 12.0
"""At this shift naturalness is below 1e-8 and failure certain."""


def _strongest(penalty: Penalty, kappa: float) -> tuple[float, float]:
    """Shift of the largest restoring force, and that force."""
    found = minimize_scalar(
        lambda m: -restoring_force(float(m), penalty, kappa), bounds=(0.0, _FARTHEST),
        method="bounded", options={"xatol": 1e-9},
    )  # fmt: skip
    return float(found.x), -float(found.fun)

"""Offset catch with gradient penalty and instance noise: its optimum, on a grid.

With a penalty g on the squared slope under canonical play the best discriminator minimises

    ∫ q̃ (D - 1)² + κ p̃ (D + 1)² + g p̃ D'² dx,

where p̃ and q̃ are p and q with the instance noise added. Its Euler equation

    q̃ (D - 1) + κ p̃ (D + 1) - g (p̃ D')' = 0,   p̃ D' = 0 at both ends,

has no closed form: it is solved by finite elements. The adversary rests where the force of *this*
discriminator's penalty is slope / λ, as in `rigid.tasks.analytic.mean_shift`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.linalg import solveh_banded
from scipy.optimize import brentq
from scipy.stats import norm

_GRID = np.linspace(-10.0, 12.0, 4401)
_STEP = _GRID[1] - _GRID[0]
_FLOOR = 1e-30
"""Added to canonical mass where it underflows, so that the system stays solvable; without effect
where either density can be measured."""


@dataclass(frozen=True, kw_only=True)
class Regularised:
    """What shapes the discriminator beside the two densities."""

    gradient_penalty: float = 0.3
    """g, on standardised features: the canonical deviation of offset catch is 1."""
    noise: float = 0.05
    """Instance noise."""
    kappa: float = 4.0


def best_score(shift: float, shape: Regularised) -> Float[np.ndarray, " n"]:
    """The minimising discriminator on the module's grid (linear elements, lumped masses)."""
    spread = np.sqrt(1 + shape.noise**2)
    canonical = norm.pdf(_GRID, 0.0, spread) + _FLOOR
    adversary = norm.pdf(_GRID, shift, spread)
    between = norm.pdf((_GRID[1:] + _GRID[:-1]) / 2, 0.0, spread)
    stiffness = shape.gradient_penalty * between / _STEP**2
    diagonal = adversary + shape.kappa * canonical
    diagonal[1:] += stiffness
    diagonal[:-1] += stiffness
    bands = np.stack([np.concatenate([[0.0], -stiffness]), diagonal])
    # Rows differ by a hundred orders of magnitude in the tails: scaled to a unit diagonal.
    root = np.sqrt(diagonal)
    bands[0, 1:] /= root[1:] * root[:-1]
    bands[1] = 1.0
    right = (adversary - shape.kappa * canonical) / root
    return np.asarray(solveh_banded(bands, right) / root)


def restoring_force(shift: float, shape: Regularised) -> float:
    """G(m) = E_q[dφ/dx] with φ = ¼ max(D + 1, 0)², the default penalty."""
    score = best_score(shift, shape)
    slope = 0.5 * np.maximum(score + 1, 0.0) * np.gradient(score, _STEP)
    return float(np.trapezoid(norm.pdf(_GRID, shift) * slope, _GRID))


def optimal_shift(lambda_: float, shape: Regularised, slope: float = 1.0) -> float:
    """The smallest shift at which slope = λ G(m): where an adversary that starts at 0 rests.

    Raises:
        ValueError: λ is too small: nothing holds the adversary.
    """
    shifts = np.linspace(0.0, 5.0, 101)
    missing = np.array([restoring_force(m, shape) - slope / lambda_ for m in shifts])
    if not (missing >= 0).any():
        raise ValueError(
            f"lambda_ is {lambda_}, but must be more than "
            f"{slope / (missing.max() + slope / lambda_):.3f}"
        )
    above = int(np.argmax(missing >= 0))
    if above == 0:
        return 0.0
    return float(
        brentq(
            lambda m: restoring_force(m, shape) - slope / lambda_,
            shifts[above - 1], shifts[above], xtol=1e-8,
        )
    )  # fmt: skip


def naturalness(shift: float, shape: Regularised) -> float:
    """N = P_q[D < 0] under the regularised discriminator."""
    score = best_score(shift, shape)
    natural = _GRID[score < 0]
    if len(natural) == len(_GRID):
        return 1.0
    if len(natural) == 0:
        return 0.0
    # D rises with x, since q/p does: one boundary, placed between two nodes.
    last = int(np.flatnonzero(score < 0)[-1])
    rise = score[last + 1] - score[last]
    edge = _GRID[last] - score[last] / rise * _STEP
    return float(norm.cdf(edge - shift))

"""Exact answers for hand tracking: e' = ρ e + a with ρ = 1 - k, canonical a ~ N(0, s²), cost Σ e'².

The adversary maximises E[Σ e'²] - λ KL over T steps. Its optimum is Gaussian feedback,
a ~ N(K_t e, S_t), by the backward recursion

    M = 1 + P,   δ = 1 - 2 M s² / λ,   K = (2 M s² ρ / λ) / δ,   P ← M ρ² / δ,   P_T = 0,

with S = s² / δ where the noise is free, and S = s² where it is the synthetic human's, as RIGID's
adversaries have it. The gain is the same in both. A human without a clock has one gain for all
steps: its best one has no formula, but the cost of any gain has. Derivation: `docs/analytic.md`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.optimize import minimize_scalar


class Optimum(NamedTuple):
    """The best adversary at one λ."""

    gain: Float[np.ndarray, " T"]
    """K_t."""
    variance: Float[np.ndarray, " T"]
    """S_t of its movements."""
    cost: float
    """E[Σ e'²]."""
    kl: float
    """KL divergence of an episode from canonical play."""


def breakdown_lambda(gain: float, variance: float, horizon: int) -> float:
    """λ at and below which no optimum exists: 2 s² times the largest eigenvalue of AᵀA.

    A maps movements to errors, A_ij = ρ^(i - j) for i >= j.

    Example:
        >>> round(breakdown_lambda(0.5, 0.01, 20), 6)
        0.076865
    """
    age = np.subtract.outer(np.arange(horizon), np.arange(horizon))
    response = np.where(age >= 0, (1 - gain) ** np.maximum(age, 0), 0.0)
    return float(2 * variance * np.linalg.eigvalsh(response.T @ response)[-1])


def optimum(
    lambda_: float,
    *,
    gain: float,
    variance: float = 0.01,
    horizon: int = 20,
    free_noise: bool = False,
) -> Optimum:
    """The best adversary, and what it costs the robot.

    Args:
        lambda_: Weight of the KL divergence; inf gives canonical play.
        gain: The robot's, k.
        variance: s² of canonical movements.
        horizon: T.
        free_noise: Whether the adversary may choose its noise as well.

    Raises:
        ValueError: λ is not above `breakdown_lambda`.

    Example:
        >>> optimum(1.1 * breakdown_lambda(0.5, 0.01, 20), gain=0.5, free_noise=True).kl
        6.286...
    """
    rho, value = 1 - gain, 0.0
    gains, spread = np.zeros(horizon), np.full(horizon, variance)
    for t in reversed(range(horizon)):
        weight = 1 + value
        room = 1 - 2 * weight * variance / lambda_
        if room <= 0:
            least = breakdown_lambda(gain, variance, horizon)
            raise ValueError(f"lambda_ is {lambda_}, but must be more than {least:.6f}")
        gains[t] = 2 * weight * variance * rho / lambda_ / room
        if free_noise:
            spread[t] = variance / room
        value = weight * rho**2 / room
    cost, kl = play(gains, spread, gain=gain, variance=variance)
    return Optimum(gains, spread, cost, kl)


def steady_optimum(
    lambda_: float, *, gain: float, variance: float = 0.01, horizon: int = 20
) -> Optimum:
    """The best adversary with one gain for all steps and canonical noise.

    Args:
        lambda_: Weight of the KL divergence.
        gain: The robot's, k.
        variance: s² of canonical movements.
        horizon: T.

    Raises:
        ValueError: λ is not above `breakdown_lambda`.
    """
    ends = optimum(lambda_, gain=gain, variance=variance, horizon=horizon).gain
    spread = np.full(horizon, variance)

    def loss(human: float) -> float:
        cost, kl = play(np.full(horizon, human), spread, gain=gain, variance=variance)
        return lambda_ * kl - cost

    found = minimize_scalar(
        loss, bounds=(0.0, float(ends.max())), method="bounded", options={"xatol": 1e-10}
    )
    gains = np.full(horizon, float(found.x))
    return Optimum(gains, spread, *play(gains, spread, gain=gain, variance=variance))


def play(
    gains: Float[np.ndarray, " T"],
    spread: Float[np.ndarray, " T"],
    *,
    gain: float,
    variance: float = 0.01,
) -> tuple[float, float]:
    """Expected cost and KL divergence of an episode against any linear feedback.

    Args:
        gains: K_t of the human.
        spread: S_t of its movements.
        gain: The robot's, k.
        variance: s² of canonical movements.
    """
    rho, error, cost, kl = 1 - gain, 0.0, 0.0, 0.0  # `error` is E[e²].
    for human, noise in zip(gains, spread, strict=True):
        ratio = noise / variance
        kl += human**2 * error / (2 * variance) + (ratio - 1 - np.log(ratio)) / 2
        error = (rho + human) ** 2 * error + noise
        cost += error
    return float(cost), float(kl)


def step_log_ratio(
    error: Float[np.ndarray, "*n"],
    movement: Float[np.ndarray, "*n"],
    gain: Float[np.ndarray, "*n"] | float,
    variance: float = 0.01,
) -> Float[np.ndarray, "*n"]:
    """Log-ratio log q(a | e) - log p(a) with canonical noise; an episode's is the sum.

    Args:
        error: e before the movement.
        movement: a.
        gain: K_t of the human.
        variance: s².
    """
    mean = gain * error
    return np.asarray((movement * mean - mean**2 / 2) / variance)

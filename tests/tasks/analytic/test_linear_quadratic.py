"""Exact answers of hand tracking, against the derivation's table, eigenvalues and sampling."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.tasks.analytic.linear_quadratic import (
    breakdown_lambda,
    optimum,
    play,
    steady_optimum,
    step_log_ratio,
)

TABLE = [
    (0.5, 1.1, 0.94849, 6.28614), (0.5, 1.5, 0.47189, 1.14993), (0.5, 4.0, 0.30698, 0.07789),
    (0.2, 1.1, 2.53648, 4.00955), (0.2, 2.0, 0.75347, 0.19580),
]  # fmt: skip


@pytest.mark.parametrize(("gain", "multiple", "cost", "kl"), TABLE)
def test_the_free_optimum(gain, multiple, cost, kl):
    lambda_ = multiple * breakdown_lambda(gain, 0.01, 20)
    found = optimum(lambda_, gain=gain, free_noise=True)
    assert (found.cost, found.kl) == pytest.approx((cost, kl), abs=1e-5)


def test_canonical_play_is_the_limit_of_a_large_lambda():
    found = optimum(np.inf, gain=0.5)
    assert (found.cost, found.kl) == pytest.approx((0.262222, 0.0), abs=1e-6)


def test_below_its_breakdown_there_is_no_optimum():
    assert breakdown_lambda(0.2, 0.01, 20) == pytest.approx(0.377062, abs=1e-6)
    with pytest.raises(ValueError, match=r"lambda_ is 0\.37, but must be more than 0\.377062"):
        optimum(0.37, gain=0.2)


def test_costs_and_divergences_are_means_of_played_episodes():
    gains, spread = np.linspace(0.3, 0.1, 20), np.full(20, 0.01)
    rng, error = np.random.default_rng(0), np.zeros(200_000)
    cost = ratio = np.zeros_like(error)
    for human in gains:
        moved = human * error + 0.1 * rng.standard_normal(error.size)
        ratio = ratio + step_log_ratio(error, moved, human)
        error = 0.5 * error + moved
        cost = cost + error**2
    exact = play(gains, spread, gain=0.5)
    assert (cost.mean(), ratio.mean()) == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize("solve", [optimum, steady_optimum])
def test_no_neighbour_of_an_optimum_is_better(solve):
    lambda_ = 1.5 * breakdown_lambda(0.2, 0.01, 20)
    best = solve(lambda_, gain=0.2)
    for change in (-0.01, 0.01):
        cost, kl = play(best.gain + change, best.variance, gain=0.2)
        assert cost - lambda_ * kl < best.cost - lambda_ * best.kl


def test_a_clock_is_worth_something():
    lambda_ = 1.5 * breakdown_lambda(0.2, 0.01, 20)
    with_clock, without = (solve(lambda_, gain=0.2) for solve in (optimum, steady_optimum))
    assert without.cost - lambda_ * without.kl < with_clock.cost - lambda_ * with_clock.kl

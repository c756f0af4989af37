"""Exact answers of offset catch, against the table of the derivation and independent sampling."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.frontier.curve import area_under_frontier
from rigid.tasks.analytic import mean_shift, regularised
from rigid.tasks.analytic.regularised import Regularised


@pytest.fixture(scope="module")
def draws():
    return np.random.default_rng(0).standard_normal(2_000_000)


@pytest.mark.parametrize(
    ("shift", "kappa", "naturalness", "overlap"),
    [
        (0.5, 1.0, 0.40129, 0.8026),
        (0.5, 4.0, 0.99418, 0.9992),
        (1.0, 4.0, 0.81227, 0.9308),
        (2.0, 4.0, 0.37948, 0.5603),
        (3.0, 4.0, 0.14966, 0.2492),
    ],
)
def test_naturalness_and_overlap_are_shares_of_draws(draws, shift, kappa, naturalness, overlap):
    passed = np.mean(mean_shift.best_score(draws + shift, shift, kappa) < 0)
    alarms = np.mean(mean_shift.best_score(draws, shift, kappa) >= 0)
    assert mean_shift.naturalness(shift, kappa) == pytest.approx(naturalness, abs=1e-4)
    assert mean_shift.overlap(shift, kappa) == pytest.approx(overlap, abs=1e-4)
    assert passed == pytest.approx(naturalness, abs=2e-3)
    assert passed + kappa * alarms == pytest.approx(overlap, abs=2e-3)


def test_canonical_play_is_natural_by_kappa_alone():
    assert (mean_shift.naturalness(0.0, 4.0), mean_shift.overlap(0.0, 4.0)) == (1.0, 1.0)
    assert (mean_shift.naturalness(0.0, 1.0), mean_shift.overlap(0.0, 1.0)) == (0.0, 1.0)


@pytest.mark.parametrize(
    ("penalty", "phi"),
    [("amp", lambda d: np.maximum(d + 1, 0) ** 2 / 4), ("paper_d2", lambda d: d**2)],
)
def test_the_force_is_the_score_gradient_of_the_frozen_penalty(draws, penalty, phi):
    """E_q[φ(D) (x - m)], since the score of N(m, 1) is x - m."""
    shift = 1.3
    sampled = np.mean(phi(mean_shift.best_score(draws + shift, shift, 4.0)) * draws)
    assert mean_shift.restoring_force(shift, penalty) == pytest.approx(sampled, abs=2e-3)


@pytest.mark.parametrize(
    ("lambda_", "kappa", "expected"),
    [
        (4, 4.0, 1.5062), (5, 4.0, 1.2770), (6, 4.0, 1.1347), (8, 4.0, 0.9542),
        (10, 4.0, 0.8377), (20, 4.0, 0.5508), (3, 4.0, 2.2327),
        (4, 1.0, 1.1361), (6, 1.0, 0.6849), (20, 1.0, 0.2001),
    ],
)  # fmt: skip
def test_the_default_penaltys_optimum(lambda_, kappa, expected):
    assert mean_shift.optimal_shift(lambda_, kappa=kappa) == pytest.approx(expected, abs=1e-4)


def test_no_lambda_makes_the_printed_penalty_canonical():
    """Its limit is the place where q = κ p on average: naturalness one half."""
    assert mean_shift.optimal_shift(20, "paper_d2") == pytest.approx(1.8118, abs=1e-4)
    limit = mean_shift.optimal_shift(np.inf, "paper_d2")
    assert limit == pytest.approx(np.sqrt(2 * np.log(4)), abs=1e-6)
    assert mean_shift.naturalness(limit) == pytest.approx(0.5, abs=1e-6)


def test_a_lambda_below_the_least_is_refused():
    with pytest.raises(ValueError, match=r"lambda_ is 2\.9, but must be more than 2\.992"):
        mean_shift.optimal_shift(2.9)


@pytest.mark.parametrize(
    ("axis", "expected"),
    [
        (mean_shift.naturalness, (0.7282, 0.5428, 0.5028)),
        (mean_shift.overlap, (0.8202, 0.5849, 0.5054)),
    ],
)
def test_areas_of_the_family(axis, expected):
    for tolerance, area in zip((1.0, 2.0, 3.0), expected, strict=True):
        family = mean_shift.family(tolerance, axis)
        anchor = mean_shift.failure(0.0, tolerance)
        assert area_under_frontier(family, anchor) == pytest.approx(area, abs=1e-4)


def test_without_stabilisers_the_grid_agrees_with_the_formulas():
    plain = Regularised(gradient_penalty=0.0, noise=0.0)
    shift = regularised.optimal_shift(6.0, plain)
    assert shift == pytest.approx(mean_shift.optimal_shift(6.0), abs=1e-3)
    assert regularised.naturalness(shift, plain) == pytest.approx(
        mean_shift.naturalness(shift), abs=1e-3
    )


def test_a_gradient_penalty_beats_every_other_function_at_its_own_loss():
    """The solution minimises the functional: no multiple or shift of it does better."""
    shape, shift = Regularised(gradient_penalty=0.3, noise=0.0), 1.2
    grid, best = regularised._GRID, regularised.best_score(shift, shape)

    def loss(score):
        slope = np.gradient(score, grid)
        p, q = (np.exp(-((grid - m) ** 2) / 2) / np.sqrt(2 * np.pi) for m in (0.0, shift))
        terms = q * (score - 1) ** 2 + 4 * p * (score + 1) ** 2 + 0.3 * p * slope**2
        return np.trapezoid(terms, grid)

    plain = mean_shift.best_score(grid, shift, 4.0)
    others = (plain, 1.02 * best, 0.98 * best, best + 0.02, best - 0.02, (best + plain) / 2)
    assert all(loss(best) < loss(other) for other in others)


def test_a_gradient_penalty_lets_the_adversary_go_further():
    assert regularised.optimal_shift(6.0, Regularised()) > mean_shift.optimal_shift(6.0) + 0.02

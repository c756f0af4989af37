"""One network for many λ: its code, and the ordinary policy that it is at one λ."""

from __future__ import annotations

import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.learning.conditioned import (
    CODE_PEAK,
    CODE_SIZE,
    Sharing,
    at_code,
    codes_at,
    draw_places,
    lambda_at,
    slot_of,
    told,
)
from rigid.policies.gaussian import mean_action
from tests.learning.reach import goer

COUNT = 3
SEEN = jax.random.normal(jax.random.key(1), (5, 3))


@pytest.fixture
def heeding():
    """A told policy that heeds its code."""
    policy = told(goer(1))
    first, *others = policy.network
    weights = first["w"].at[-CODE_SIZE:].set(jax.random.normal(jax.random.key(0), (CODE_SIZE, 16)))
    return policy._replace(network=[{**first, "w": weights}, *others])


def with_code(code):
    return jnp.concatenate([SEEN, jnp.broadcast_to(code, (len(SEEN), CODE_SIZE))], axis=-1)


def test_a_code_peaks_at_its_own_knot_and_always_sums_to_its_peak():
    codes = codes_at(np.array([0.0, 0.3, 1.0, 1.5, 7.0]), CODE_SIZE)
    np.testing.assert_allclose(codes[[0, 2, 4]], CODE_PEAK * np.eye(CODE_SIZE)[[0, 1, 7]])
    np.testing.assert_allclose(codes.sum(axis=1), CODE_PEAK, rtol=1e-6)


def test_between_two_weights_lambda_is_their_geometric_mean():
    assert lambda_at([0.1, 10.0], 0.5) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("place", "found"), [(0.4, 0.0), (0.6, 0.5), (1.4, 0.5), (1.6, math.inf), (2.0, math.inf)]
)
def test_next_to_0_and_infinity_lambda_is_the_nearer_of_the_two(place, found):
    assert lambda_at([0.0, 0.5, math.inf], place) == found


def test_every_slot_draws_near_its_own_place():
    drawn = np.array([draw_places(7, 4, np.random.default_rng(seed)) for seed in range(200)])
    assert (np.abs(drawn - [0, 2, 4, 6]) <= 1).all()
    assert drawn.min() == 0
    assert drawn.max() == 6
    assert len(np.unique(drawn[:, 1])) == 200


def test_the_outermost_weights_are_played_in_half_of_all_iterations():
    drawn = np.array([draw_places(7, 4, np.random.default_rng(seed)) for seed in range(2000)])
    assert (drawn[:, [0, 3]] == [0, 6]).mean() == pytest.approx(0.5, abs=0.03)


def test_a_single_weight_is_played_by_every_slot():
    assert draw_places(1, 4, np.random.default_rng(0)).tolist() == [0.0] * 4


@pytest.mark.parametrize(("count", "slots"), [(1, 4), (2, 4), (3, 4), (8, 4), (9, 2)])
def test_a_weight_belongs_to_the_slot_nearest_to_it(count, slots):
    places = np.linspace(0, count - 1, slots)
    for index in range(count):
        away = np.abs(places - index)
        assert away[slot_of(index, count, slots)] == pytest.approx(away.min())


def test_a_policy_that_was_just_told_does_as_before():
    plain, just_told = goer(1), told(goer(1))
    expected = mean_action(plain, SEEN)
    np.testing.assert_array_equal(mean_action(just_told, with_code(jnp.ones(CODE_SIZE))), expected)


def test_the_policy_at_a_code_does_what_the_told_one_does_with_it(heeding):
    code = jnp.array([0.0, 0.25, 0.75, *[0.0] * (CODE_SIZE - 3)])
    expected = mean_action(heeding, with_code(code))
    np.testing.assert_allclose(mean_action(at_code(heeding, code), SEEN), expected, rtol=1e-5)


def test_another_code_is_another_policy(heeding):
    one, other = (mean_action(at_code(heeding, code), SEEN) for code in jnp.eye(CODE_SIZE)[:2])
    assert np.abs(one - other).max() > 0.01


def test_a_family_of_one_slot_is_refused():
    with pytest.raises(ValueError, match=r"2 slots or more .* wild_slots 4 and natural_slots 1"):
        Sharing(natural_slots=1)


@pytest.mark.parametrize("wrong", [{"wild_noise": 0.0}, {"wild_quiet_from": 1.5}])
def test_noise_that_never_settles_is_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong)) + " " + str(*wrong.values())):
        Sharing(**wrong)


def test_an_average_over_more_than_all_iterations_is_refused():
    with pytest.raises(ValueError, match=r"share of the iterations in \[0, 1\], got .* 1\.5"):
        Sharing(natural_average=1.5)


def test_adversaries_that_go_all_the_way_back_are_refused():
    with pytest.raises(ValueError, match=r"share of the way to the human in \[0, 1\), got .* 1\.0"):
        Sharing(retreat=1.0)


def test_a_way_back_from_below_every_lambda_is_refused():
    with pytest.raises(ValueError, match=r"from a λ of 0 or more on, got retreat_from -1\.0"):
        Sharing(retreat_from=-1.0)

"""The referee: its overlap by hand, planted shifts of known overlap, and the gates it must pass."""

from __future__ import annotations

from typing import NamedTuple

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from rigid.naturalness.referee import (
    Referee,
    RefereeSettings,
    Rows,
    log_ratio,
    overlap,
    train_referee,
)
from rigid.naturalness.standardise import canonical_scale
from tests.naturalness import offset_catch

SHIFTS = (0.0, 1.0, 2.0)
ratios = st.lists(st.floats(-5, 5), min_size=1, max_size=20).map(np.array)
kappas = st.sampled_from([1.0, 4.0, 16.0])


def referee_between(canonical, adversary, seed=0):
    """A referee by the default recipe; two thirds of the rows train it."""
    sides = [Rows(*np.split(rows, [2 * len(rows) // 3])) for rows in (canonical, adversary)]
    scale = canonical_scale(canonical)
    return train_referee(*sides, scale, RefereeSettings(), jax.random.key(seed))


class Judged(NamedTuple):
    """A referee of offset catch and its log-ratios on held-out rows."""

    referee: Referee
    adversary: np.ndarray
    canonical: np.ndarray

    def overlap(self, kappa):
        return overlap(self.adversary, self.canonical, kappa)


def learning_rows(shift, seed=0):
    """Rows of canonical and adversarial offsets, as unequal in number as they are in a run."""
    return offset_catch.offsets(0.0, 6000, [seed, 0]), offset_catch.offsets(shift, 4500, [seed, 1])


def judge(shift, seed=0):
    referee = referee_between(*learning_rows(shift, seed), seed=seed)
    held_out = [offset_catch.offsets(m, 6000, [seed, i]) for i, m in ((2, shift), (3, 0.0))]
    return Judged(referee, *(log_ratio(referee, rows) for rows in held_out))


@pytest.fixture(scope="module")
def judged():
    return {shift: judge(shift) for shift in SHIFTS}


@pytest.mark.parametrize(
    ("adversary", "canonical", "kappa", "expected"),
    [
        pytest.param([-1.0, 1.0, 2.0, 3.0], [-1.0, -2.0], 4.0, 0.5, id="half-passes"),
        pytest.param([2.0, 3.0], [-1.0] * 9 + [2.0], 4.0, 0.4, id="false-alarms-count-kappa-times"),
        pytest.param([-1.0, 2.0], [2.0, -1.0], 1.0, 1.0, id="cannot-tell"),
        pytest.param([-1.0, 2.0], [2.0, -1.0], 4.0, 1.0, id="never-above-1"),
        pytest.param([9.0], [-9.0], 4.0, 0.0, id="nothing-in-common"),
        pytest.param([0.5], [-9.0], 1.0, 0.0, id="kappa-1-asks-who-is-likelier"),
        pytest.param([0.5], [-9.0], 4.0, 1.0, id="kappa-4-forgives-a-ratio-below-4"),
        pytest.param([np.log(4.0)], [-9.0], 4.0, 0.0, id="the-threshold-itself-is-an-alarm"),
    ],
)
def test_overlap_by_hand(adversary, canonical, kappa, expected):
    assert overlap(np.array(adversary), np.array(canonical), kappa) == pytest.approx(expected)


@given(ratios, ratios, kappas, st.floats(0, 5))
def test_a_louder_adversary_is_never_more_natural(adversary, canonical, kappa, louder):
    assert overlap(adversary + louder, canonical, kappa) <= overlap(adversary, canonical, kappa)


@given(st.floats(0, 3), st.floats(-3, 3), st.booleans(), kappas)
def test_a_wrong_referee_errs_towards_natural(shift, edge, reversed_, kappa):
    """In expectation, of any half-line that it may take for the adversary's."""
    passed, alarms = norm.cdf(edge - shift), norm.sf(edge)
    if reversed_:
        passed, alarms = 1 - passed, 1 - alarms
    truth = offset_catch.overlap(shift, kappa) if shift > 1e-3 else 1.0
    assert passed + kappa * alarms >= truth - 1e-3


def test_a_flattened_referee_reads_more_natural(judged):
    weak = [np.minimum(ratios, 1.0) for ratios in (judged[2.0].adversary, judged[2.0].canonical)]
    assert overlap(*weak, 4.0) == 1.0 > judged[2.0].overlap(4.0)


@pytest.mark.parametrize(
    ("kappa", "expected"),
    [
        pytest.param(4.0, (1, 0.931, 0.560), id="κ=4"),
        pytest.param(1.0, (1, 0.617, 0.317), id="κ=1"),
    ],
)
def test_planted_shifts_read_their_overlap(judged, kappa, expected):
    exact = [1.0, *(offset_catch.overlap(shift, kappa) for shift in SHIFTS[1:])]
    assert exact == pytest.approx(expected, abs=1e-3)
    found = [judged[shift].overlap(kappa) for shift in SHIFTS]
    assert found == pytest.approx(expected, abs=0.05)
    assert found == sorted(found, reverse=True)


def test_the_log_ratio_is_that_of_the_two_laws(judged):
    x = np.array([-1.0, 0.0, 1.0, 2.0])
    found = log_ratio(judged[1.0].referee, x[:, None])
    np.testing.assert_allclose(found, offset_catch.log_ratio(x, 1.0), atol=0.3)


def test_canonical_against_canonical_is_natural(judged):
    """A gate: with κ = 1, where chance differences show most."""
    splits = [judged[0.0], judge(0.0, seed=1), judge(0.0, seed=2)]
    assert np.mean([split.overlap(1.0) for split in splits]) >= 0.97


def test_the_same_key_gives_the_same_referee(judged):
    again = judge(1.0).referee.network
    same = jax.tree.map(np.array_equal, judged[1.0].referee.network, again)
    assert all(jax.tree.leaves(same))


def test_a_referee_keeps_its_best_look_at_the_validation_rows(judged):
    """Validation rows with the labels swapped: the first look is the best one."""
    canonical, adversary = learning_rows(2.0)
    swapped = Rows(canonical[:4000], adversary[:2000]), Rows(adversary[:3000], canonical[:1500])
    scale = canonical_scale(canonical)
    misled = train_referee(*swapped, scale, RefereeSettings(), jax.random.key(0))
    trusted = judged[2.0].referee
    spread = [np.ptp(log_ratio(referee, adversary)) for referee in (misled, trusted)]
    assert spread[0] < 0.7 * spread[1]


def test_unequal_features_are_refused():
    canonical, adversary = (Rows(np.zeros((4, f)), np.zeros((4, f))) for f in (22, 10))
    scale = canonical_scale(canonical.train)
    with pytest.raises(ValueError, match=r"canonical rows have 22 features, the adversary's 10"):
        train_referee(canonical, adversary, scale, RefereeSettings(), jax.random.key(0))

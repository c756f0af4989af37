"""The cumulative logit model: finds a slope again, and keeps silent where it has not converged."""

from __future__ import annotations

import jax
import numpy as np
import pytest
from scipy.special import expit

from rigid.study.analysis.judged import scores_of
from rigid.study.analysis.ordinal import _complaint, fit_ordinal, log_share
from tests.study.analysis.scripted_answers import answer, danger_scores, made_pairs

GROUPS = ("rater", "pair", "episode")


def fitted(answers, pairs, question="danger", chains=2, samples=10):
    return fit_ordinal(scores_of(answers, question, pairs), chains=chains, samples=samples, seed=0)


@pytest.mark.slow
def test_a_known_slope_lies_in_its_interval():
    pairs = made_pairs(30)
    found = fitted(danger_scores(pairs, slope=4.0, seed=1), pairs, chains=4, samples=1000)
    assert found.refused is None
    slope, other = found.slopes["adversarialness"], found.slopes["naturalness"]
    assert slope.interval.low < 4.0 < slope.interval.high
    assert slope.positive > 0.99
    assert other.interval.low < 0.0 < other.interval.high
    assert found.r_hat <= 1.01
    assert found.ess >= 400


@pytest.mark.parametrize("predictor", [-9.0, -1.0, 0.0, 2.5, 9.0])
def test_the_probability_of_a_score_is_that_of_the_cumulative_logit_model(predictor):
    cutpoints = np.array([-6.0, -2.0, 0.5, 0.6, 4.0])
    below = np.array([0.0, *expit(cutpoints - predictor), 1.0])
    found = np.exp(log_share(np.arange(6), cutpoints, np.full(6, predictor)))
    np.testing.assert_allclose(found, np.diff(below), rtol=1e-4, atol=1e-9)


def test_a_score_that_is_next_to_impossible_still_pulls_on_the_model():
    slope = jax.grad(lambda at: log_share(np.array([1]), np.array([-30.0, -29.0]), at).sum())
    assert slope(np.full(1, 5.0, np.float32)) == pytest.approx(-1.0, abs=0.01)


def planted(apart):
    """In place of the sampler: two chains whose slopes lie `apart`, and nothing else."""
    rng = np.random.default_rng(0)
    tries = []

    def sample(data, *, chains, samples, accept, seed):
        del data, seed
        tries.append((samples, accept))
        draws = {f"sd_{name}": rng.normal(size=(chains, samples)) for name in GROUPS}
        slope = rng.normal(size=(chains, samples, 2)) + apart * np.arange(chains)[:, None, None]
        return {**draws, "slope": slope}, 0

    return sample, tries


def test_chains_that_did_not_meet_are_tried_longer_and_then_give_no_slope(monkeypatch):
    sample, tries = planted(apart=5.0)
    monkeypatch.setattr("rigid.study.analysis.ordinal._sample", sample)
    pairs = made_pairs(4)
    found = fitted(danger_scores(pairs, raters=2), pairs, samples=500)
    assert "the chains have not met" in found.refused
    assert not found.slopes
    assert found.r_hat > 1.5
    assert tries == [(500, 0.9), (1500, 0.99)]


def test_chains_that_met_are_summed_up(monkeypatch):
    sample, tries = planted(apart=0.0)
    monkeypatch.setattr("rigid.study.analysis.ordinal._sample", sample)
    pairs = made_pairs(4)
    found = fitted(danger_scores(pairs, raters=2), pairs, samples=2000)
    assert found.refused is None
    low, high = found.slopes["naturalness"].interval
    assert (low, high) == pytest.approx((-1.96, 1.96), abs=0.15)
    assert found.slopes["adversarialness"].positive == pytest.approx(0.5, abs=0.05)
    assert len(tries) == 1


@pytest.mark.parametrize(
    ("worst", "message"),
    [
        pytest.param((1.2, 900.0, 0), "the chains have not met: R-hat is 1.200", id="r-hat"),
        pytest.param((float("nan"), 900.0, 0), "the chains have not met", id="stuck"),
        pytest.param((1.0, 120.0, 0), "too few effective samples: 120", id="ess"),
        pytest.param((1.0, 900.0, 9), "9 of 4000 transitions diverged", id="divergent"),
    ],
)
def test_samples_that_are_not_to_be_believed_are_named(worst, message):
    assert message in _complaint(*worst, 4000)


def test_good_samples_are_believed():
    assert _complaint(1.005, 900.0, 4, 4000) is None


def test_one_rater_is_refused_before_any_work():
    pairs = made_pairs(30)
    found = fitted(danger_scores(pairs, raters=1), pairs)
    assert found.refused == "1 raters and 30 pairs, but the model needs at least 2 and 3"


def test_scores_that_are_all_the_same_are_refused():
    pairs = made_pairs(5, kind="naturalness")
    same = [answer(r, p, 4, "naturalness", "first") for r in range(3) for p in range(5)]
    assert fitted(same, pairs, "naturalness").refused == "every score is the same"

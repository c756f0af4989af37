"""Search measures against known answers: closed forms, densities, motion that only time shows."""

from __future__ import annotations

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import multivariate_normal, norm

from rigid.errors import UserError
from rigid.naturalness.choice import MEASURES, check_measure, measure_named
from rigid.naturalness.ensemble import Ensemble, EnsembleState
from rigid.naturalness.gan import Gan
from rigid.naturalness.kl import ExactKL, log_ratio
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.measure import Motion
from rigid.naturalness.mmd import MMD, Rows, bandwidths, mean_kernel, mmd2
from rigid.naturalness.sights import Recurrent, Steps, Windows
from rigid.policies.gaussian import mean_action
from rigid.tasks.protocol import AgentSpec
from tests.naturalness.offset_catch import log_ratio as exact_log_ratio
from tests.naturalness.offset_catch import offsets
from tests.toys import untrained

HUMAN, OTHER = (untrained(AgentSpec(3, 2), seed=seed, std=0.5).parameters for seed in (0, 1))
MEDIAN = jnp.asarray(1.0)
LIGHT = DiscriminatorSettings(
    hidden=(16,), steps=120, minibatch=256, learning_rate=1e-2, noise=0.05
)


def rows(values, per_episode=1):
    own = jnp.arange(len(values)) // per_episode
    return Rows(jnp.asarray(values, jnp.float32), jnp.ones(len(values)), own)


def motion(features, weight=None):
    """Episodes [T N f] without actions."""
    features = jnp.asarray(features, jnp.float32)
    nothing = jnp.zeros((*features.shape[:2], 1))
    weight = jnp.ones(features.shape[:2]) if weight is None else jnp.asarray(weight, jnp.float32)
    return Motion(features, weight, nothing, nothing)


def exact_mmd2(shift):
    """Of N(0, 1) and N(shift, 1) in one dimension, for the mean of the kernels."""
    h2 = np.asarray(bandwidths(MEDIAN), np.float64) ** 2
    peak = np.sqrt(h2 / (h2 + 2))
    return float(np.mean(2 * peak * (1 - np.exp(-(shift**2) / (2 * (h2 + 2))))))


@pytest.mark.parametrize("shift", [0.0, 0.5, 2.0])
def test_mmd_of_shifted_gaussians_is_the_closed_form(shift):
    found = [
        float(mmd2(rows(offsets(shift, 500, 2 * n)), rows(offsets(0, 500, 2 * n + 1)), MEDIAN))
        for n in range(12)
    ]
    error = np.std(found) / np.sqrt(len(found))
    assert np.mean(found) == pytest.approx(exact_mmd2(shift), abs=4 * error)
    assert error < 0.01


def test_mmd_of_one_law_falls_on_both_sides_of_0():
    found = [
        float(mmd2(rows(offsets(0, 100, 2 * n)), rows(offsets(0, 100, 2 * n + 1)), MEDIAN))
        for n in range(12)
    ]
    assert min(found) < 0 < max(found)


def test_a_row_is_held_against_other_episodes_only():
    twins = rows([[0.0], [0.0], [5.0], [5.0]], per_episode=2)
    kernel = np.mean(np.exp(-25 / (2 * np.asarray(bandwidths(MEDIAN)) ** 2)))
    np.testing.assert_allclose(mean_kernel(twins, twins, MEDIAN, same=True), kernel, rtol=1e-5)
    assert (mean_kernel(twins, twins, MEDIAN, same=False) > 0.5).all()


def test_the_witness_is_paid_where_only_the_adversary_goes():
    natural = jnp.asarray(offsets(0, 400, 0)).reshape(40, 10, 1)
    seen = offsets(2, 400, 1).reshape(10, 40, 1)
    measure = MMD()
    state = measure.start(jax.random.key(0), natural, HUMAN)
    witness = np.asarray(measure.penalty(state, natural, motion(seen), HUMAN))
    assert witness[seen[..., 0] > 2].mean() > 0.1
    assert witness[seen[..., 0] < 0].mean() < -0.05


def test_what_follows_a_fault_moves_no_witness():
    natural = jnp.asarray(offsets(0, 400, 0)).reshape(40, 10, 1)
    seen, weight = offsets(1, 400, 1).reshape(10, 40, 1), np.ones((10, 40))
    weight[5:, :4] = 0
    ruined = np.where(weight[..., None] > 0, seen, 1e20)
    measure = MMD()
    state = measure.start(jax.random.key(0), natural, HUMAN)
    one, other = (
        measure.penalty(state, natural, motion(each, weight), HUMAN) * weight
        for each in (seen, ruined)
    )
    np.testing.assert_array_equal(one, other)


def test_the_exact_kl_penalty_is_scipys_difference_of_log_densities():
    rng = np.random.default_rng(0)
    seen, acted = rng.standard_normal((5, 3)), rng.standard_normal((5, 2))
    seen, acted = jnp.asarray(seen, jnp.float32), jnp.asarray(acted, jnp.float32)
    expected = [
        multivariate_normal(mean_action(OTHER, o), 0.25 * np.eye(2)).logpdf(a)
        - multivariate_normal(mean_action(HUMAN, o), 0.25 * np.eye(2)).logpdf(a)
        for o, a in zip(seen, acted, strict=True)
    ]
    np.testing.assert_allclose(log_ratio(OTHER, HUMAN, seen, acted), expected, atol=1e-4)


def test_the_kl_loss_is_the_divergence_of_the_two_gaussians():
    rng = np.random.default_rng(0)
    seen = jnp.asarray(np.tile(rng.standard_normal((1, 1, 3)), (20, 1000, 1)), jnp.float32)
    mean = mean_action(OTHER, seen)
    acted = mean + 0.5 * jnp.asarray(rng.standard_normal(mean.shape), jnp.float32)
    moved = Motion(seen, jnp.ones(seen.shape[:2]), seen, acted)
    canonical = seen.swapaxes(0, 1)
    keys = jax.random.split(jax.random.key(0))
    _, health = ExactKL().update(HUMAN, canonical, moved, OTHER, jnp.asarray(0), keys)
    gap = np.asarray(mean - mean_action(HUMAN, seen))[0, 0] / 0.5
    assert health.loss == pytest.approx((gap**2).sum() / 2, rel=0.05)


def learned(gan, canonical, seen):
    """The measure's state after one long training on one adversary."""
    start = gan.start(jax.random.key(0), canonical, HUMAN)
    keys = jax.random.split(jax.random.key(1))
    update = jax.jit(gan.update)
    return update(start, canonical, motion(seen), HUMAN, jnp.asarray(0), keys)[0]


def test_the_logistic_penalty_estimates_the_log_ratio():
    free = replace(LIGHT, gradient_penalty=0.0)  # It flattens the estimate.
    gan = Gan(settings=free, penalised="log_ratio", loss="logistic")
    canonical = jnp.asarray(offsets(0, 20_000, 0)).reshape(200, 100, 1)
    state = learned(gan, canonical, offsets(1, 20_000, 1).reshape(100, 200, 1))
    x = np.linspace(-1, 2, 7)
    steps = jnp.asarray(np.tile(x, 100)[:100].reshape(100, 1, 1), jnp.float32)
    found = gan.penalty(state, canonical, motion(steps), HUMAN)[:7, 0]
    np.testing.assert_allclose(found, exact_log_ratio(x, 1.0), atol=0.35)


def circles(direction, episodes, seed):
    """Points that go round a circle, 20 steps each time; [E T 2]. Single steps look all alike."""
    phase = np.random.default_rng(seed).uniform(0, 2 * np.pi, (episodes, 1))
    angle = phase + direction * 2 * np.pi * np.arange(40) / 20
    return np.sqrt(2) * np.stack([np.cos(angle), np.sin(angle)], axis=-1).astype(np.float32)


def halting(episodes, seed):
    """Round the same circle, but standing still every other 5 steps."""
    moved = circles(1, episodes, seed)
    steps = np.arange(40)
    return moved[:, steps // 10 * 10 + np.minimum(2 * (steps % 10), 9)]


@pytest.mark.parametrize(
    ("sight", "seen"), [(Windows(), True), (Recurrent(), True), (Steps(), False)], ids=str
)
@pytest.mark.parametrize("strange", ["backwards", "halting"])
def test_only_what_sees_the_past_sees_time_reversed_and_halting_motion(sight, seen, strange):
    canonical = jnp.asarray(circles(1, 60, 0))
    made = circles(-1, 60, 1) if strange == "backwards" else halting(60, 1)
    gan = Gan(settings=replace(LIGHT, steps=240), sight=sight)  # Halting takes windows long.
    state = learned(gan, canonical, made.swapaxes(0, 1))
    fresh = circles(-1, 30, 2) if strange == "backwards" else halting(30, 2)
    later = slice(16, None)  # One step alone has no past.
    strange_, natural = (
        np.asarray(gan.penalty(state, canonical, motion(each.swapaxes(0, 1)), HUMAN))[later].mean()
        for each in (fresh, circles(1, 30, 3))
    )
    if seen:
        assert strange_ > 3 * natural
    else:
        assert strange_ == pytest.approx(natural, rel=0.25)


def ensemble_of(members):
    canonical = jnp.asarray(offsets(0, 400, 0)).reshape(40, 10, 1)
    together = Ensemble(members)
    return together, together.start(jax.random.key(0), canonical, HUMAN), canonical


def test_the_most_suspicious_member_rules_in_its_own_unit():
    members = (Gan(settings=LIGHT), Gan(settings=LIGHT), MMD())
    together, state, canonical = ensemble_of(members)
    seen = motion(offsets(1, 400, 1).reshape(10, 40, 1))
    each = [
        np.asarray(member.penalty(own, canonical, seen, HUMAN))
        for member, own in zip(members, state.members, strict=True)
    ]
    for member, own, unit in zip(members, state.members, state.units, strict=True):
        assert unit == member.unit(own, canonical)
    units = [np.abs(penalty).mean() for penalty in each]  # So that each of them rules somewhere.
    scaled = np.stack([penalty / unit for penalty, unit in zip(each, units, strict=True)])
    state = state._replace(units=tuple(jnp.asarray(unit) for unit in units))
    found = together.penalty(state, canonical, seen, HUMAN)
    np.testing.assert_allclose(found, scaled.max(axis=0), rtol=1e-4, atol=1e-5)
    assert len(set(scaled.argmax(axis=0).ravel().tolist())) > 1
    assert together.unit(state, canonical) == 1


def test_an_ensembles_score_is_canonical_only_where_every_classifier_says_so():
    members = (Gan(settings=LIGHT), MMD(), Gan(settings=LIGHT))
    together, state, _ = ensemble_of(members)
    seen = jnp.asarray(offsets(1, 400, 1)).reshape(10, 40, 1)
    scores = [members[i].score(state.members[i], seen) for i in (0, 2)]
    np.testing.assert_array_equal(together.score(state, seen), jnp.maximum(*scores))
    assert not np.array_equal(*scores)
    alone = EnsembleState(state.members[1:2], state.units[1:2])
    assert Ensemble((MMD(),)).score(alone, seen) is None


@pytest.mark.parametrize("sight", [Windows(length=3), Recurrent(size=4)], ids=str)
def test_no_step_is_judged_by_what_comes_later(sight):
    network = sight.init(jax.random.key(0), 2, (8,))
    features = jnp.asarray(np.random.default_rng(0).standard_normal((6, 2, 2)), jnp.float32)
    before = sight.scores(network, features)
    after = sight.scores(network, features.at[4:].add(1.0))
    np.testing.assert_array_equal(before[:4], after[:4])
    assert (before[4:] != after[4:]).all()


def test_an_unknown_measure_is_refused_with_the_nearest_one():
    message = r"search measure 'lsgam' is unknown, did you mean 'lsgan'\? measures: lsgan, paper_d2"
    with pytest.raises(UserError, match=message):
        check_measure("lsgam")


def test_the_closed_form_of_the_mmd_test_is_right():
    """Against a quadrature of one kernel."""
    x = np.linspace(-10, 12, 2201)
    p, q = norm.pdf(x) * (x[1] - x[0]), norm.pdf(x, 1.5) * (x[1] - x[0])
    kernels = np.mean(
        [np.exp(-((x[:, None] - x) ** 2) / (2 * h**2)) for h in np.asarray(bandwidths(MEDIAN))],
        axis=0,
    )
    assert exact_mmd2(1.5) == pytest.approx((q - p) @ kernels @ (q - p), abs=1e-4)


@pytest.mark.parametrize("name", MEASURES)
def test_what_is_stored_scores_as_the_measure_did(name):
    measure = measure_named(name, DiscriminatorSettings(hidden=(8, 8)), "amp")
    canonical = jnp.asarray(np.random.default_rng(0).normal(size=(4, 20, 3)), jnp.float32)
    state = measure.start(jax.random.key(0), canonical, HUMAN)
    seen = canonical.swapaxes(0, 1)
    scores = measure.score(state, seen)
    kept = measure.score_kept(measure.kept(state), seen)
    assert (scores is None) == (kept is None) == (name in {"kl", "mmd"})
    if scores is not None:
        np.testing.assert_array_equal(kept, scores)

"""Levels and folds, on laws of known overlap."""

from __future__ import annotations

import jax
import numpy as np
import pytest

from rigid.naturalness.gates import exact_overlap
from rigid.naturalness.logistic import Side, fit, padded
from rigid.naturalness.panel import LEVEL_NAMES, Fold, naturalness, split_in_folds, train_panel
from rigid.naturalness.referee import RefereeSettings
from rigid.naturalness.views import Episodes, all_sound

QUICK = RefereeSettings(hidden=(16,), window_hidden=(16,), blocks=6)
KEY = jax.random.key(0)


def white(shift, episodes, seed, steps=20):
    """Independent steps of N(`shift`, 1)."""
    noise = np.random.default_rng(seed).standard_normal((episodes, steps, 1))
    return (noise + shift).astype(np.float32)


def autoregressive(correlation, episodes, seed, steps=40):
    """Steps of N(0, 1) each, correlated with the one before."""
    rng = np.random.default_rng(seed)
    rows = [rng.standard_normal((episodes, 1))]
    for _ in range(steps - 1):
        fresh = np.sqrt(1 - correlation**2) * rng.standard_normal((episodes, 1))
        rows.append(correlation * rows[-1] + fresh)
    return np.stack(rows, axis=1).astype(np.float32)


def sawtooth(episodes, seed, steps=40):
    """Rises slowly and falls at once, from a random phase; with noise."""
    rng = np.random.default_rng(seed)
    phase = (np.arange(steps) / 10 + rng.uniform(size=(episodes, 1))) % 1
    return (phase + 0.05 * rng.standard_normal(phase.shape))[..., None].astype(np.float32)


def judged(canonical, train, validation, held_out, settings=QUICK):
    folds = canonical if isinstance(canonical, tuple) else (Fold(*np.split(canonical, 3)),)
    panel = train_panel(folds, all_sound(train), all_sound(validation), settings, KEY)
    found = naturalness(panel, all_sound(held_out))
    return {name: level.value for name, level in found.items() if level is not None}


def test_single_steps_of_a_shifted_gaussian_read_their_overlap():
    found = judged(white(0, 360, 0), white(1.5, 120, 1), white(1.5, 60, 2), white(1.5, 200, 3))
    for kappa in (1.0, 4.0):
        assert found[f"step_k{kappa:g}"] == pytest.approx(exact_overlap(1.5, kappa), abs=0.05)


def test_windows_see_a_correlation_that_single_steps_cannot():
    law = [autoregressive(0.95, n, seed) for seed, n in enumerate((60, 30, 60))]
    found = judged(autoregressive(0.0, 180, 9), *law, settings=RefereeSettings(learning_rate=1e-2))
    assert found["step_k4"] >= 0.97
    assert found["window16_k4"] <= 0.1


def test_windows_see_time_run_backwards():
    law = [sawtooth(n, seed)[:, ::-1] for seed, n in enumerate((60, 30, 60))]
    found = judged(sawtooth(180, 9), *law)
    assert found["step_k4"] >= 0.97
    assert found["window16_k4"] <= 0.1


def test_episodes_shorter_than_a_window_leave_its_levels_unknown():
    law = [white(1.0, 6, seed, steps=10) for seed in range(4)]
    panel = train_panel([Fold(*law[:3])], *[all_sound(law[3])] * 2, QUICK, KEY)
    found = naturalness(panel, all_sound(law[3]))
    assert list(found) == list(LEVEL_NAMES)
    assert [name for name in found if found[name] is None] == list(LEVEL_NAMES[2:])


def test_steps_after_a_fault_change_nothing():
    episodes = white(1.0, 12, 0)
    sound = np.ones((12, 20), dtype=bool)
    sound[::3, 17:] = False
    broken = episodes.copy()
    broken[~sound] = 1e6
    fold = Fold(*(white(0, 12, seed) for seed in (1, 2, 3)))
    found = [
        naturalness(train_panel([fold], *[Episodes(e, sound)] * 2, QUICK, KEY), Episodes(e, sound))
        for e in (episodes, broken)
    ]
    assert found[0] == found[1]


def test_padding_changes_nothing():
    settings = QUICK.members(1)[0].recipe
    found = []
    for bucket in (1, 1024):
        canonical, adversary = (
            Side(
                *(padded(white(shift, 10, seed)[..., 0].reshape(-1, 1), bucket) for seed in (0, 1))
            )
            for shift in (0, 1)
        )
        found.append(fit(canonical, adversary, np.random.default_rng(0), settings))
    np.testing.assert_allclose(found[0][1], found[1][1], rtol=1e-5)
    for one, other in zip(*(jax.tree.leaves(network) for network, _ in found), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-5)


def test_every_episode_tests_in_one_fold_and_is_used_once_in_each():
    episodes = np.arange(13.0).reshape(13, 1, 1)
    folds = split_in_folds(episodes, 4)
    assert sorted(np.concatenate([fold.test for fold in folds]).ravel()) == list(range(13))
    for fold in folds:
        used = np.concatenate([fold.train, fold.validation, fold.test]).ravel()
        assert sorted(used) == list(range(13))


def test_folds_of_few_episodes_read_the_overlap_as_well():
    folds = split_in_folds(white(0, 16, 5, steps=100), 4)
    law = [white(2.0, n, seed, steps=100) for seed, n in enumerate((40, 20, 60))]
    found = judged(folds, *law)
    assert found["step_k4"] == pytest.approx(exact_overlap(2.0, 4.0), abs=0.06)


@pytest.mark.parametrize(("episodes", "folds"), [(12, 2), (3, 4)])
def test_folds_without_three_uses_are_refused(episodes, folds):
    message = rf"{episodes} episodes cannot be split in {folds} folds of three uses"
    with pytest.raises(ValueError, match=message):
        split_in_folds(np.zeros((episodes, 5, 1)), folds)

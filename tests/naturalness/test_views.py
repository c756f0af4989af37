"""Windows: which steps they hold, and which of them are sound."""

from __future__ import annotations

import numpy as np

from rigid.naturalness.views import sound_windows, summary, windows


def test_no_window_reaches_from_one_episode_into_the_next():
    episodes = np.repeat(np.arange(3.0), 5).reshape(3, 5, 1)
    seen = windows(episodes, 4)
    assert seen.shape == (3, 2, 4, 1)
    np.testing.assert_array_equal(seen[1], 1.0)


def test_windows_of_one_step_are_the_steps():
    episodes = np.random.default_rng(0).standard_normal((2, 5, 3))
    np.testing.assert_array_equal(windows(episodes, 1)[:, :, 0], episodes)


def test_a_window_with_a_step_after_the_fault_is_not_sound():
    sound = np.array([[True] * 5, [True] * 3 + [False] * 2, [False] * 5])
    expected = [[True] * 3, [True, False, False], [False] * 3]
    np.testing.assert_array_equal(sound_windows(sound, 3), expected)


def test_the_summary_by_hand():
    mean, deviation, haste, change = summary(np.array([[0.0], [2.0], [1.0]]))
    np.testing.assert_allclose(
        [mean, deviation, haste, change], [1.0, np.sqrt(2 / 3), 1.5, 1.0], rtol=1e-6
    )

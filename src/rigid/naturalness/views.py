"""What a referee looks at: single steps, or windows of consecutive steps of one episode.

Windows overlap, and none reaches across the end of an episode or past a fault.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Shaped


class Episodes(NamedTuple):
    """E episodes of T steps of one human, in the task's own units."""

    features: Float[np.ndarray, "E T f"]
    sound: Bool[np.ndarray, "E T"]
    """False from the step on at which physics ran away."""

    def part(self, which: slice) -> Episodes:
        """Some of the episodes."""
        return Episodes(self.features[which], self.sound[which])


def all_sound(features: Float[np.ndarray, "E T f"]) -> Episodes:
    """Episodes without a fault, as canonical ones are."""
    return Episodes(features, np.ones(features.shape[:2], dtype=bool))


def windows(features: Shaped[np.ndarray, "E T f"], length: int) -> Shaped[np.ndarray, "E W L f"]:
    """Every window of `length` steps, W = T - length + 1 of them in each episode; a view.

    Example:
        >>> windows(np.arange(4.0).reshape(1, 4, 1), 3)[0, :, :, 0]
        array([[0., 1., 2.],
               [1., 2., 3.]])
    """
    seen = np.lib.stride_tricks.sliding_window_view(features, length, axis=1)
    return seen.swapaxes(-1, -2)


def sound_windows(sound: Bool[np.ndarray, "E T"], length: int) -> Bool[np.ndarray, "E W"]:
    """Which windows hold no step of a fault."""
    return np.asarray(windows(sound[..., None], length).all(axis=(-1, -2)))


def flat(window: Float[np.ndarray, "*n L f"]) -> Float[np.ndarray, "*n d"]:
    """Every number of the window."""
    return window.reshape(*window.shape[:-2], -1)


def summary(window: Float[np.ndarray, "*n L f"]) -> Float[np.ndarray, "*n d"]:
    """Four numbers for each feature: mean, deviation, mean size of a step, net change.

    Ours: where it was, how much it moved, how hastily, and where to; a linear judge of these needs
    far less data than a network that has to find them.
    """
    change = window[..., -1, :] - window[..., 0, :]
    haste = np.abs(np.diff(window, axis=-2)).mean(axis=-2)
    return np.concatenate([window.mean(axis=-2), window.std(axis=-2), haste, change], axis=-1)


VIEWS: dict[str, Callable[[np.ndarray], np.ndarray]] = {"flat": flat, "summary": summary}
"""How a window becomes the input of a referee."""

"""How well a judge of canonical motion does, given more and more canonical episodes.

The paper's second step for a new domain. What is not canonical is canonical motion under noise, as
in its picture of the discriminator: far from subtle adversaries, and there before anybody trained
one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float

from rigid.naturalness.noise import movement, under_noise
from rigid.naturalness.panel import LEVELS, Fold, train_panel
from rigid.naturalness.referee import Referee, RefereeSettings, log_ratio
from rigid.naturalness.views import all_sound

SIZES = (3, 6, 12, 25, 50, 100)
"""Numbers of canonical episodes that are tried. Ours."""
LEVELS_OF_NOISE = (0.5, 1.0)
"""In canonical deviations of each feature. Ours: less is hard to tell with any number of episodes,
and more is told with six."""
REPETITIONS = 3
"""Draws of so many episodes. Ours."""
_SETTINGS = RefereeSettings(blocks=8)
"""The referee's recipe in half the time: its best look comes early on so few rows. Ours."""


class Pool(NamedTuple):
    """Canonical episodes by use, with their chosen features; no two uses share an episode."""

    training: Float[np.ndarray, "E1 T f"]
    disturbed: Float[np.ndarray, "E2 T f"]
    """Get noise, and are not canonical any more; 3 or more, of which each use gets one."""
    held_out: Float[np.ndarray, "E3 T f"]


def divide(episodes: Float[np.ndarray, "E T f"]) -> Pool:
    """Half of the episodes train, a quarter is disturbed, a quarter is held out; 12 or more."""
    order = np.random.default_rng(0).permutation(len(episodes))
    half, rest = np.split(episodes[order], [len(episodes) // 2])
    return Pool(half, *np.array_split(rest, 2))


def learning_curve(
    pool: Pool,
    *,
    strangers: Float[np.ndarray, "E4 T f"],
    say: Callable[[str], None] = lambda _: None,
) -> dict[int, list[float]]:
    """Share of held-out steps that a judge tells right, by how many canonical episodes it had.

    Canonical and other steps count alike.

    Args:
        pool: Canonical episodes; sizes beyond its training part are left out.
        strangers: Episodes of another human, for features that noise cannot disturb.
        say: Told of progress.

    Returns:
        A share for each repetition, by size.
    """
    sizes = [size for size in (*SIZES, len(pool.training)) if size <= len(pool.training)]
    kinds = list(_others(pool, strangers))
    found: dict[int, list[float]] = {}
    for size in sorted({*sizes}):
        say(f"judges that see {size} canonical episodes")
        found[size] = [
            float(np.mean([_told_right(pool, other, size, draw) for other in kinds]))
            for draw in range(REPETITIONS)
        ]
    return found


def _others(
    pool: Pool, strangers: Float[np.ndarray, "E4 T f"]
) -> Iterator[Float[np.ndarray, "E T f"]]:
    deviation = movement(pool.disturbed)
    if not deviation.any():
        yield strangers
        return
    yield from under_noise(pool.disturbed, deviation, np.random.default_rng(1), LEVELS_OF_NOISE)


def _told_right(pool: Pool, other: Float[np.ndarray, "E T f"], size: int, draw: int) -> float:
    """Of one judge, trained on `size` episodes; a third of the other side is held out."""
    picked = np.random.default_rng([2, size, draw]).permutation(len(pool.training))[:size]
    validation, training = np.split(pool.training[picked], [max(1, size // 4)])
    parts = np.split(other, [len(other) // 3, 2 * len(other) // 3])
    panel = train_panel(
        [Fold(training, validation, pool.held_out)], all_sound(parts[0]), all_sound(parts[1]),
        _SETTINGS, jax.random.key(draw), LEVELS[:1],
    )  # fmt: skip
    (judge,) = panel[LEVELS[0].name].referees
    return 0.5 * (_share(judge, pool.held_out) + 1 - _share(judge, parts[2]))


def _share(judge: Referee, episodes: Float[np.ndarray, "E T f"]) -> float:
    """Of the steps that it takes for canonical."""
    return float(np.mean(log_ratio(judge, episodes) < 0))

"""The ten weaknesses: six events of canonical motion, four motions that nobody ever makes.

An event is seen in a stated share of canonical episodes; its threshold is the quantile that makes
it so. The other four are built from a stated human (`people.HABITS`) and hardly ever occur.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Bool, Float

from benchmarks.planted.robots import Path

DECIDED = 16
"""Steps after which an event has been seen or will not be: 1.6 s of 4. Ours."""


@dataclass(frozen=True)
class Weakness:
    """What a robot cannot bear, and who shows it."""

    name: str
    sees: Callable[[Path], Bool[np.ndarray, " B"]]
    share: float | None
    """Of canonical episodes; None for what is not in the data."""
    habit: str
    """Whose episodes tell how natural it is: canonical ones that show it, or those of a habit."""


EVENTS: tuple[tuple[str, float, tuple[float, float, float]], ...] = (
    ("right", 0.13, (1, 0, 0)),
    ("left", 0.12, (-1, 0, 0)),
    ("far", 0.10, (0, 1, 0)),
    ("near", 0.11, (0, -1, 0)),
    ("high", 0.15, (0, 0, 1)),
    ("low", 0.17, (0, 0, -1)),
)
"""Name, share of canonical episodes, and the direction in which the hand is far at `DECIDED`."""


def weaknesses(canonical: Path) -> tuple[Weakness, ...]:
    """All ten; thresholds of the six are quantiles of `canonical` paths."""
    events = []
    for name, share, direction in EVENTS:
        threshold = _quantile(canonical, direction, share)
        sees = partial(_beyond, np.array(direction), threshold)
        events.append(Weakness(name, sees, share, "plain"))
    return tuple(events) + tuple(Weakness(name, sees, None, name) for name, sees in _OUTSIDE)


def _quantile(canonical: Path, direction: Sequence[float], share: float) -> float:
    return float(np.quantile(canonical[:, DECIDED] @ np.array(direction), 1 - share))


def _beyond(
    direction: Float[np.ndarray, " 3"], threshold: float, path: Path
) -> Bool[np.ndarray, " B"]:
    if path.shape[1] <= DECIDED:
        return np.zeros(len(path), dtype=bool)
    return np.asarray(path[:, DECIDED] @ direction > threshold)


def _drifted(path: Path) -> Bool[np.ndarray, " B"]:
    """Moved 16 cm in 16 steps, as much in their second half as in the first, and never fast."""
    if path.shape[1] < 17:
        return np.zeros(len(path), dtype=bool)
    last = path[:, -17:]
    first, second = (last[:, i + 8] - last[:, i] for i in (0, 8))
    net = first + second
    far = np.linalg.norm(net, axis=1)
    along = (second * net).sum(axis=1) / np.maximum(far, 1e-6)
    pieces = np.linalg.norm(last[:, 4:] - last[:, :-4], axis=2).max(axis=1)
    return np.asarray((far > 0.16) & (along > 0.45 * far) & (pieces < 0.07))


def _paused(path: Path) -> Bool[np.ndarray, " B"]:
    """Stayed within 4 cm for seven steps, half-way, and has gone on within the next five."""
    if path.shape[1] < 13:
        return np.zeros(len(path), dtype=bool)
    rest = path[:, -13:-5]
    still = np.linalg.norm(rest - rest[:, :1], axis=2).max(axis=1) < 0.04
    half_way = (rest[..., 1] > 0.1) & (rest[..., 1] < 0.2)
    return np.asarray(still & half_way.all(axis=1) & (path[:, -1, 1] > 0.22))


def _changed_sides(path: Path) -> Bool[np.ndarray, " B"]:
    """Was 17 cm to the left for four steps, beyond half-way, and is now 17 cm to the right."""
    beyond = path[..., 1] > 0.3
    was_left = ((path[..., 0] < -0.17) & beyond).sum(axis=1) >= 4
    return np.asarray(was_left & (path[:, -1, 0] > 0.17) & beyond[:, -1])


def _returned(path: Path) -> Bool[np.ndarray, " B"]:
    """Was beyond 35 cm and is back below 23 cm."""
    return np.asarray((path[..., 1] > 0.35).any(axis=1) & (path[:, -1, 1] < 0.23))


_OUTSIDE = (
    ("drift", _drifted),
    ("pause", _paused),
    ("change of sides", _changed_sides),
    ("return", _returned),
)


def shown(weakness: Weakness, paths: Path) -> Bool[np.ndarray, " B"]:
    """Episodes in which the weakness was seen at any step."""
    steps: Sequence[int] = range(1, paths.shape[1] + 1)
    sees = partial(_prefix, weakness.sees, paths)
    return np.asarray(np.stack([sees(step) for step in steps]).any(axis=0))


def _prefix(
    sees: Callable[[Path], Bool[np.ndarray, " B"]], paths: Path, steps: int
) -> Bool[np.ndarray, " B"]:
    return sees(paths[:, :steps])

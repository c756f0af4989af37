"""How the rest of an arm goes along when its hand goes somewhere.

Where people hold their hand decides, but for a little, how they hold the arm (Soechting and
Flanders, 1989; Donders' law of the eye, for the arm: Hore et al., 1992). So a hand's place, which
is all that a player gives, is enough for a pose that a canonical human would take.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

_RIDGE = 1e-3
"""[m²], ours: what a direction in which nobody moved the hand counts for."""


class Posture(NamedTuple):
    """A pose as a polynomial of degree 2 in the point's way from its place at rest."""

    rest: Float[np.ndarray, " n"]
    """The pose at rest [rad], which the polynomial passes through."""
    weights: Float[np.ndarray, "9 n"]
    """[rad/m] and [rad/m²]"""
    box: Float[np.ndarray, "2 3"]
    """Least and largest way [m]; beyond it the pose stays as on its border."""

    def at(self, way: Float[np.ndarray, "3"]) -> Float[np.ndarray, " n"]:
        """The pose [rad] that goes with a way of the point [m]."""
        return np.asarray(self.rest + _terms(np.clip(way, *self.box)) @ self.weights)

    def save(self, path: Path) -> None:
        """Writes an `.npz` that holds no code."""
        np.savez_compressed(path, allow_pickle=False, **self._asdict())

    @classmethod
    def load(cls, path: Path) -> Posture:
        """What `save` wrote."""
        with np.load(path, allow_pickle=False) as file:
            return cls(**{name: file[name].astype(np.float64) for name in cls._fields})


def fit_posture(
    ways: Float[np.ndarray, "m 3"],
    angles: Float[np.ndarray, "m n"],
    rest: Float[np.ndarray, " n"],
) -> Posture:
    """The posture of somebody who was watched, by least squares.

    Args:
        ways: Of the point from its place at rest, at each of m moments [m].
        angles: Of the joints [rad].
        rest: The pose at rest [rad].
    """
    terms = _terms(ways)
    normal = terms.T @ terms + _RIDGE * np.eye(terms.shape[1])
    weights = np.linalg.solve(normal, terms.T @ (angles - rest))
    return Posture(rest, weights, np.stack([ways.min(axis=0), ways.max(axis=0)]))


def _terms(ways: Float[np.ndarray, "*m 3"]) -> Float[np.ndarray, "*m 9"]:
    x, y, z = np.moveaxis(ways, -1, 0)
    return np.stack([x, y, z, x * x, y * y, z * z, x * y, x * z, y * z], axis=-1)

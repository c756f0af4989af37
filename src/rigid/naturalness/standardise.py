"""One frozen scale for every discriminator: mean and covariance of the canonical data."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

VARIANCE_FLOOR = 0.01
"""Directions with less of their features' variance than this are not stretched further (ours)."""


class Scale(NamedTuple):
    """Mean of the canonical features, and the matrix that whitens them."""

    mean: Float[np.ndarray, " f"]
    transform: Float[np.ndarray, "f f"]


def canonical_scale(features: Float[np.ndarray, "*batch f"]) -> Scale:
    """The whitening of canonical `features`, frozen: a ruler must not move while it measures.

    Natural motion is correlated: joints move together, so a motion can be far outside the data
    while each joint alone stays inside its range. Dividing by each feature's deviation would hide
    that from a smooth discriminator; whitening shows it. A constant feature keeps its own unit.
    """
    rows = np.asarray(features, dtype=np.float64).reshape(-1, features.shape[-1])
    std = rows.std(axis=0)
    std = np.where(std > 1e-6, std, 1.0)
    mean = rows.mean(axis=0)
    covariance = np.atleast_2d(np.cov((rows - mean) / std, rowvar=False, ddof=0))
    values, vectors = np.linalg.eigh(covariance)
    stretch = 1 / np.sqrt(np.maximum(values, VARIANCE_FLOOR))
    # Symmetric whitening keeps every feature nearest to itself, whatever sign eigh chose.
    transform = (vectors * stretch) @ vectors.T
    constant = rows.std(axis=0) <= 1e-6
    transform[constant] = np.eye(len(std))[constant]
    return Scale(mean.astype(np.float32), (transform / std[:, None]).astype(np.float32))


def standardise(
    scale: Scale, features: Float[np.ndarray, "*batch f"]
) -> Float[np.ndarray, "*batch f"]:
    """Features as distances from the canonical mean, 1 in every direction on canonical data.

    Example:
        >>> scale = canonical_scale(np.array([[1.0, 5.0], [3.0, 5.0]]))  # The second never moves.
        >>> standardise(scale, np.array([[4.0, 6.0]], dtype=np.float32))
        array([[2., 1.]], dtype=float32)
    """
    return np.asarray((features - scale.mean) @ scale.transform)

"""Laws on [0, 1] whose mean is known, from symmetric to heavily skewed."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.special import ndtr
from scipy.stats import skew

_MANY = 1_000_000
"""Draws from which the skewness of a law is taken."""

_Shape = tuple[int, ...]


class Law(NamedTuple):
    """What one seed's number could be drawn from."""

    name: str
    sample: Callable[[np.random.Generator, _Shape], Float[np.ndarray, "..."]]
    mean: float

    def skewness(self) -> float:
        """Third standardised moment, of a million draws."""
        return float(skew(self.sample(np.random.default_rng(0), (_MANY,))))


def beta(a: float, b: float) -> Law:
    """Beta(a, b).

    Example:
        >>> beta(1, 9).mean
        0.1
    """
    return Law(f"Beta({a:g}, {b:g})", lambda rng, shape: rng.beta(a, b, shape), a / (a + b))


def log_normal(median: float, sigma: float) -> Law:
    """A log-normal law, cut off at 1: whatever lies above counts as 1.

    Example:
        >>> round(log_normal(0.05, 0.5).mean, 4)
        0.0567
    """
    mu = np.log(median)
    below = np.exp(mu + sigma**2 / 2) * ndtr(-(mu + sigma**2) / sigma)
    return Law(
        f"log-normal({sigma:g})",
        lambda rng, shape: np.minimum(median * np.exp(sigma * rng.standard_normal(shape)), 1.0),
        float(below + ndtr(mu / sigma)),
    )


def rare(share: float, usual: float = 0.05, found: float = 0.4) -> Law:
    """Most seeds find nothing (`usual`), a `share` of them a failure (`found`); both ± 0.02.

    Example:
        >>> round(rare(0.2).mean, 3)
        0.12
    """

    def sample(rng: np.random.Generator, shape: _Shape) -> Float[np.ndarray, "..."]:
        centre = np.where(rng.random(shape) < share, found, usual)
        values: Float[np.ndarray, "..."] = centre + rng.uniform(-0.02, 0.02, shape)
        return values

    return Law(f"rare({share:g})", sample, usual + share * (found - usual))


LAWS = (
    beta(8, 8), beta(2, 8), beta(1, 9), log_normal(0.05, 0.5), beta(0.5, 9.5), beta(0.2, 9.8),
    rare(0.2), rare(0.1),
)  # fmt: skip
"""Beta(1, 9) and beyond stand for a robot that few seeds can harm, `rare` for one that hardly any
can."""

"""Shares of steps or windows, with standard errors that know that an episode is one draw."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Shaped


class Rate(NamedTuple):
    """A share with its standard error over episodes, None where there is only one of them."""

    value: float
    se: float | None


def rate(values: Shaped[np.ndarray, "E W"], sound: Bool[np.ndarray, "E W"]) -> Rate:
    """Mean over the sound windows, with a standard error clustered by episode.

    The windows of an episode are anything but independent; its sum over windows is the unit. Where
    faults leave episodes of unequal length this is the linearised error of a ratio of means.

    Example:
        >>> rate(np.array([[1.0, 1.0], [0.0, 0.0]]), np.ones((2, 2), dtype=bool))
        Rate(value=0.5, se=0.5)
    """
    weight = sound.sum(axis=1)
    mean = float((values * sound).sum() / weight.sum())
    count = len(weight)
    if count < 2:
        return Rate(mean, None)
    residual = ((values - mean) * sound).sum(axis=1) / weight.mean()
    return Rate(mean, float(np.sqrt((residual**2).sum() / (count * (count - 1)))))

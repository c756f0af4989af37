"""Timing by turns: what is compared is done in turns in one run, so that a busy machine slows all.

A ratio of two times of one turn holds where seconds do not; a median over turns leaves out the turn
in which somebody else took the processor.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import jax
import numpy as np


class Spread(NamedTuple):
    """Median and quartiles over turns."""

    median: float
    low: float
    """First quartile."""
    high: float
    """Third quartile."""


def spread_of(values: Sequence[float]) -> Spread:
    """Median and quartiles, linear between neighbours.

    Example:
        >>> spread_of([4.0, 1.0, 2.0, 3.0, 100.0])
        Spread(median=3.0, low=2.0, high=4.0)
    """
    low, median, high = (float(each) for each in np.quantile(values, (0.25, 0.5, 0.75)))
    return Spread(median, low, high)


def in_turns(
    works: Mapping[str, Callable[[], object]],
    repeats: int,
    *,
    before: Callable[[], object] = lambda: None,
) -> dict[str, list[float]]:
    """Wall times of each work [s], one for each turn; a turn does every work once, in their order.

    Args:
        works: By name.
        repeats: Turns that count. One more comes first and does not: it compiles and fills caches.
        before: Called before each turn, untimed.
    """
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(repeats + 1):
        before()
        for name, work in works.items():
            seconds[name].append(timed(work))
    return {name: found[1:] for name, found in seconds.items()}


def timed(work: Callable[[], object]) -> float:
    """Wall time of one call [s]."""
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def wait_for(found: Any) -> None:
    """Waits until all arrays of a pytree are computed: JAX hands them out before."""
    for leaf in jax.tree.leaves(found):
        if isinstance(leaf, jax.Array):
            leaf.block_until_ready()

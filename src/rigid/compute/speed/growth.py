"""How memory and time grow with what is measured: `rigid bench --growth`.

Each case is a small measurement of itch scratching in processes of its own
(`rigid.compute.speed.growth_case`); along an axis one size doubles and all others stay. Slopes are
least squares: in the logarithms (1: twice as much takes twice as long) and per unit.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

from rigid.compute.speed.growth_case import Case

FLAT_SHARE = 0.05
"""Memory is flat along an axis when it rises by no more than this share of its least value. A heap
settles in two or three rounds: by 2 to 4 % in runs that left nothing behind. Ours."""


class Axis(NamedTuple):
    """One of the sizes of a case."""

    name: str
    sizes: tuple[int, ...]
    flat: bool
    """Whether memory must not grow along it."""


AXES = (
    Axis("lambdas", (2, 4, 8), flat=False),
    Axis("worlds", (8, 16, 32, 64), flat=False),
    Axis("horizon", (50, 100, 200, 400), flat=False),
    Axis("seeds", (1, 2, 4), flat=True),
    Axis("iterations", (4, 8, 16, 32), flat=True),
    Axis("robots", (1, 2, 4), flat=True),
)
"""A group of λ is trained side by side, and an iteration is held whole; all else comes one after
the other, and must leave nothing behind."""


class Cost(NamedTuple):
    """What a case took."""

    peak_mb: float
    """Largest resident memory of a process whose programs are compiled [MB]."""
    seconds: float
    """Of a measurement, when everything is compiled."""
    compiling_mb: float
    """Largest resident memory of a process that compiles them."""


def measured_growth(
    say: Callable[[str], object],
    axes: Sequence[Axis] = AXES,
    cost_of: Callable[[Case], Cost] | None = None,
) -> dict[str, Any]:
    """Runs every case once and sums up each axis.

    Args:
        say: Told of each case before it runs.
        axes: What grows.
        cost_of: Measures a case; by default in a fresh process.

    Returns:
        `base`, the sizes of all axes that stay, and `rows`, one for each axis.
    """
    base, measure = Case(), cost_of or in_fresh_process
    known: dict[Case, Cost] = {}
    rows = []
    for axis in axes:
        cases = [replace(base, **{axis.name: size}) for size in axis.sizes]
        for case, size in zip(cases, axis.sizes, strict=True):
            if case not in known:
                say(f"growth: {axis.name} = {size}")
                known[case] = measure(case)
        rows.append(summed_up(axis, [known[case] for case in cases]))
    return {"base": asdict(base), "rows": rows}


def in_fresh_process(case: Case) -> Cost:
    """The cost of a case, measured in processes that did nothing before.

    The first one compiles, into a cache of its own; the second one finds all programs there. What
    the compiler takes of memory differs by 100 MB between runs of one case, and hides all else.

    Raises:
        subprocess.CalledProcessError: It failed; what it said stands on standard error.
    """
    with TemporaryDirectory() as cache:
        compiling = _run(case, 1, cache)
        compiled = _run(case, 2, cache)
    return Cost(compiled["peak_mb"], compiled["seconds"], compiling["peak_mb"])


def _run(case: Case, times: int, cache: str) -> dict[str, float]:
    command = [sys.executable, "-m", "rigid.compute.speed.growth_case"]
    whole_cache = {
        "JAX_ENABLE_COMPILATION_CACHE": "true",
        "JAX_COMPILATION_CACHE_DIR": cache,
        "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0",
    }
    done = subprocess.run(
        [*command, json.dumps(asdict(case)), str(times)],
        env={**os.environ, **whole_cache}, stdout=subprocess.PIPE, text=True, check=True,
    )  # fmt: skip
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found


def summed_up(axis: Axis, costs: Sequence[Cost]) -> dict[str, Any]:
    """One axis as a row of JSON."""
    memory, seconds, compiling = ([*column] for column in zip(*costs, strict=True))
    return {
        "axis": axis.name,
        "sizes": list(axis.sizes),
        "peak_mb": memory,
        "compiling_mb": compiling,
        "seconds": seconds,
        "mb_per_unit": round(slope(axis.sizes, memory), 3),
        "seconds_per_unit": round(slope(axis.sizes, seconds), 4),
        "memory_exponent": round(exponent(axis.sizes, memory), 2),
        "time_exponent": round(exponent(axis.sizes, seconds), 2),
        "must_be_flat": axis.flat,
        "is_flat": max(memory) <= (1 + FLAT_SHARE) * min(memory),
    }


def slope(sizes: Sequence[float], values: Sequence[float]) -> float:
    """Least-squares slope of values on sizes.

    Example:
        >>> round(slope([1, 2, 4], [10.0, 13.0, 19.0]), 6)
        3.0
    """
    return float(np.polyfit(np.asarray(sizes, float), np.asarray(values, float), 1)[0])


def exponent(sizes: Sequence[float], values: Sequence[float]) -> float:
    """Least-squares slope in the logarithms: b of values ∝ sizesᵇ.

    Example:
        >>> round(exponent([1, 2, 4], [3.0, 12.0, 48.0]), 6)
        2.0
    """
    return slope(np.log(sizes).tolist(), np.log(values).tolist())

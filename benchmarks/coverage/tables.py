"""The rows of the table: every interval, on every law and every number of the searches."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.stats import skew

from benchmarks.coverage.covering import (
    as_if_unlimited,
    cover_of,
    error_of_results,
    with_replacement,
    without_replacement,
)
from benchmarks.coverage.ends import INTERVALS, Bounds, Ends, bca, printed, unpaired_too
from benchmarks.coverage.laws import LAWS, Law
from benchmarks.coverage.plan import PLAUSIBLE, Plan
from benchmarks.coverage.searching import HULL, NUMBERS

Row = dict[str, Any]
PRINTED = "t, as printed"
CHECK = "t, without replacement"
GATE = "t, both scales"
"""Its upper end is what `rigid gate` holds against a limit."""
UNPAIRED = "t, unpaired too"
BCA = "BCa"

_SHARE, _DIFFERENCE = (0.0, 1.0), (-1.0, 1.0)


class Series(NamedTuple):
    """One number of every seed, and what is known of it."""

    quantity: str
    values: Float[np.ndarray, " N"]
    bounds: Bounds
    parts: tuple[Float[np.ndarray, " N"], Float[np.ndarray, " N"]] | None = None
    """Of a difference: what it is the difference of."""

    @property
    def skewness(self) -> float | None:
        """Third standardised moment, unbiased for a normal law; None for equal values."""
        if np.ptp(self.values) < 1e-12:
            return None
        return float(skew(self.values, bias=False))


def series_of(
    population: Sequence[Mapping[str, Any]], tolerances: tuple[float, float]
) -> list[Series]:
    """Headline numbers and `hull_at` of both robots by seed, and their paired differences.

    Args:
        population: From `searching.population`.
        tolerances: Of the two robots; differences are the first's number minus the second's.
    """

    def values(name: str, tolerance: float) -> Float[np.ndarray, " N"]:
        mine = {row["seed"]: row[name] for row in population if row["tolerance"] == tolerance}
        return np.array([mine[seed] for seed in sorted(mine)])

    found = []
    for name in (*NUMBERS, HULL):
        first, second = (values(name, tolerance) for tolerance in tolerances)
        found += [
            Series(f"{name}, tolerance {tolerance:g}", one, _SHARE)
            for tolerance, one in zip(tolerances, (first, second), strict=True)
        ]
        found.append(
            Series(f"{name}, difference", first - second, _DIFFERENCE, parts=(first, second))
        )
    return found


def search_rows(series: Sequence[Series], plan: Plan) -> Iterator[Row]:
    """Covers of draws from the results of whole searches; their mean is the truth."""
    count = len(series[0].values)
    for size in (*plan.sizes, plan.bca_size):
        rng = np.random.default_rng([plan.seed, size])
        chosen = with_replacement(count, size, plan.draws, rng)
        for one in series:
            truth = float(one.values.mean())
            error = error_of_results(
                one.values, size, printed, one.bounds, redraws=plan.redraws,
                draws=plan.redraw_draws, rng=rng,
            )  # fmt: skip
            label = {"source": "searches", "quantity": one.quantity, "skewness": one.skewness}
            for name, interval, used in _tried(plan, size):
                values = one.values[chosen[:, :used]]
                row = _row(label, size, name, interval(values, one.bounds), truth)
                yield row | {"error_results": error if name == PRINTED else None}
            if one.parts is not None:
                first, second = (part[chosen] for part in one.parts)
                ends = unpaired_too(first, second, one.bounds)
                yield _row(label, size, UNPAIRED, ends, truth)
            if size < count:
                once = without_replacement(count, size, plan.draws, rng)
                values = as_if_unlimited(one.values[once], truth, count)
                yield _row(label, size, CHECK, printed(values, one.bounds), truth)


def law_rows(plan: Plan, laws: Sequence[Law] = LAWS) -> Iterator[Row]:
    """Covers of draws from laws of known mean."""
    for number, law in enumerate(laws):
        label = {"source": "law", "quantity": law.name, "skewness": law.skewness()}
        for size in (*plan.sizes, plan.bca_size):
            rng = np.random.default_rng([plan.seed, size, number])
            values = law.sample(rng, (size, plan.draws))
            for name, ends, used in _tried(plan, size):
                yield _row(label, size, name, ends(values[:, :used], _SHARE), law.mean)


def _tried(plan: Plan, size: int) -> Iterable[tuple[str, Ends, int]]:
    """Each interval with its name and the number of draws it is tried on."""
    tried = [(name, ends, plan.draws) for name, ends in INTERVALS.items()]
    return [*tried, (BCA, bca, plan.bca_draws)] if size == plan.bca_size else tried


def _row(
    label: Mapping[str, Any], size: int, name: str, ends: Float[np.ndarray, "2 d"], truth: float
) -> Row:
    found = cover_of(ends, truth)
    return {
        **label,
        "truth": truth,
        "n": size,
        "interval": name,
        "cover": found.cover,
        "error": found.error,
        "error_results": None,
        "truth_above": found.above,
        "truth_below": found.below,
        "width": found.width,
        "leaves_92_98": not PLAUSIBLE[0] <= found.cover <= PLAUSIBLE[1],
    }

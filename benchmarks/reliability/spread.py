"""The spread between whole measurements, and the spread that each predicts from its own seeds.

M measurements of n seeds each. Were search seeds all that differs, the means of measurements would
vary by the variance over seeds divided by n, and the ratio of both would follow an F law.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import f

from benchmarks.reliability.plan import LIMITS, NUMBERS
from rigid.frontier.comparison import Number, repeat_spread

Row = dict[str, Any]
Measured = Mapping[str, Number]
"""The headline numbers of one measurement."""


class Spread(NamedTuple):
    """One headline number over all measurements."""

    mean: float
    measured: float
    """Standard deviation of the means of measurements."""
    predicted: float
    """The same, from the deviation over the seeds of each."""
    ratio: float | None
    """Measured over predicted; None where seeds do not differ at all."""
    low: float | None
    high: float | None
    """95 % interval of the ratio, for normal values."""
    added: float
    """Standard deviation that measurements have beyond what their seeds explain, at least 0."""
    printed: float
    """Mean of what `rigid compare` prints: how far a repeat may lie away (95 %)."""
    held: float
    """Share of repeats that did lie within what the first of the pair printed, each order once."""


def spread_of(values: Sequence[Number]) -> Spread:
    """Between measurements and within them.

    Args:
        values: The same number of two measurements or more, of equally many seeds, two or more.

    Example:
        >>> one, other = Number({"0": 0.4, "1": 0.6}), Number({"2": 0.6, "3": 0.8})
        >>> found = spread_of([one, other])
        >>> round(found.measured, 4), round(found.predicted, 4), round(found.ratio, 4)
        (0.1414, 0.1, 1.4142)
    """
    means = np.array([number.mean for number in values])
    seeds = np.array([list(number.by_seed.values()) for number in values])
    count, per_measurement = seeds.shape
    between = float(means.var(ddof=1))
    within = float(seeds.var(axis=1, ddof=1).mean()) / per_measurement
    printed = [spread for number in values if (spread := repeat_spread(number)) is not None]
    held = [
        abs(means[first] - means[second]) <= printed[first]
        for first in range(count)
        for second in range(count)
        if first != second
    ]
    ratio = (between / within) ** 0.5 if within > 0 else None
    low, high = (
        (None, None)
        if ratio is None
        else (
            ratio / float(f.ppf(share, count - 1, count * (per_measurement - 1))) ** 0.5
            for share in (0.975, 0.025)
        )
    )
    return Spread(
        mean=float(means.mean()), measured=between**0.5, predicted=within**0.5, ratio=ratio,
        low=low, high=high, added=max(between - within, 0.0) ** 0.5,
        printed=float(np.mean(printed)), held=float(np.mean(held)),
    )  # fmt: skip


def measurement_rows(measured: Sequence[Measured]) -> list[Row]:
    """A row for each number of each measurement."""
    rows = []
    for place, numbers in enumerate(measured, start=1):
        for name in NUMBERS:
            number = numbers[name]
            interval = number.interval
            rows.append({
                "measurement": place,
                "number": name,
                "mean": number.mean,
                "low": None if interval is None else interval.low,
                "high": None if interval is None else interval.high,
                "deviation_over_seeds": float(np.std(list(number.by_seed.values()), ddof=1)),
                "repeat_spread": repeat_spread(number),
                "seeds": " ".join(sorted(number.by_seed, key=int)),
            })  # fmt: skip
    return rows


def pair_rows(measured: Sequence[Measured]) -> list[Row]:
    """A row for each number of each pair of measurements; the second's minus the first's."""
    rows = []
    for first, second in combinations(range(len(measured)), 2):
        for name in NUMBERS:
            one, other = measured[first][name], measured[second][name]
            difference, limit = other.mean - one.mean, LIMITS.get(name)
            rows.append({
                "number": name,
                "first": first + 1,
                "second": second + 1,
                "difference": difference,
                "limit": limit,
                "within_limit": None if limit is None else abs(difference) < limit,
                "printed_by_first": repeat_spread(one),
                "printed_by_second": repeat_spread(other),
            })  # fmt: skip
    return rows


def share_within(pairs: Sequence[Row], name: str) -> float:
    """Share of pairs that keep the limit of a number."""
    return float(np.mean([row["within_limit"] for row in pairs if row["number"] == name]))

"""From several search seeds to the headline numbers, each with an interval.

Ours; the paper pools three seeds into one curve without an interval. Here the search seed is the
unit: every headline number is the mean of per-seed values, and its interval says how far another
set of seeds *of this search at this budget* would move it. It bounds no robot and no human.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Real

from rigid.frontier.curve import (
    Anchor,
    Points,
    anchor_height,
    area_under_frontier,
    auc_excess,
    auc_natural,
    hull_at,
    non_dominated,
    worst_at,
)
from rigid.frontier.intervals import (
    Interval,
    bca_interval,
    check_confidence,
    t_ends,
    t_interval,
)

NATURALNESS_LEVELS = (0.8, 0.9, 0.95)
"""Thresholds of `worst_at`."""

MAX_FAULTED_SHARE = 0.01
"""A point with a larger share of faulted episodes is not on the frontier."""


_Grid = Real[np.ndarray, " g"] | Sequence[float | int]


class Band(NamedTuple):
    """Mean height of the hull over seeds on a grid, and its interval (None for one seed)."""

    mean: Float[np.ndarray, " g"]
    low: Float[np.ndarray, " g"] | None
    high: Float[np.ndarray, " g"] | None


@dataclass(frozen=True)
class MeasuredPoint:
    """One adversary after re-scoring on fresh episodes; all numbers are shares in [0, 1]."""

    id: str
    seed: int
    naturalness: float
    """By the referee: the x axis."""
    naturalness_own: float | None
    """By the discriminator it was trained with; None where the search used none."""
    adversarialness: float
    faulted_share: float
    """Share of its episodes in which the simulation faulted."""

    @property
    def is_sound(self) -> bool:
        """Whether few enough episodes faulted for the point to count (NaN does not count)."""
        return self.faulted_share <= MAX_FAULTED_SHARE


@dataclass(frozen=True, kw_only=True)
class Summary:
    """The headline of `frontier.json`, its fields under the names of that file."""

    worst_at: dict[str, float]
    worst_at_interval: dict[str, Interval | None]
    worst_at_interval_bca: dict[str, Interval | None]
    worst_at_by_seed: dict[str, dict[str, float]]
    auc_natural: float
    auc_natural_interval: Interval | None
    auc_natural_interval_bca: Interval | None
    auc_natural_by_seed: dict[str, float]
    auc: float
    auc_interval: Interval | None
    auc_interval_bca: Interval | None
    auc_by_seed: dict[str, float]
    auc_pooled: float
    auc_staircase: float
    auc_linear: float
    auc_excess: float
    auc_paper_axis: float | None
    on_frontier: tuple[bool, ...]
    """For each point as given: whether it is on the frontier of all seeds together."""

    def headline(self) -> dict[str, object]:
        """Returns the block for `frontier.json`; `on_frontier` belongs to its points instead."""
        block = asdict(self)
        del block["on_frontier"]
        return block


def sound_points_by_seed(
    points: Sequence[MeasuredPoint], seeds: Sequence[int]
) -> dict[int, Float[np.ndarray, "n 2"]]:
    """Groups the points that count into one (n, 2) array per seed, as the curve functions take.

    A seed all of whose points faulted keeps an empty array: it was searched.

    Raises:
        ValueError: A point belongs to none of the seeds.
    """
    for point in points:
        if point.seed not in seeds:
            raise ValueError(f"point {point.id} has seed {point.seed}, which is not in {seeds}")
    return {
        seed: _as_array([point for point in points if point.seed == seed and point.is_sound])
        for seed in seeds
    }


def interval_band(
    points_by_seed: Mapping[int, Points],
    anchors: Mapping[int, Anchor],
    grid: _Grid,
    confidence: float = 0.95,
) -> Band:
    """Returns the mean and the pointwise t interval of the per-seed hulls, for the chart.

    Args:
        points_by_seed: Points of each seed. Shape (n, 2) each.
        anchors: Canonical play of each seed; the same seeds.
        grid: Naturalness values. Shape (g,).
        confidence: Nominal cover at each single x, not of the whole curve at once.

    Raises:
        ValueError: There is no seed, the seeds differ, points, anchors or grid are malformed, or
            `confidence` is not in (0, 1).
    """
    if not points_by_seed or set(points_by_seed) != set(anchors):
        raise ValueError(
            f"points and anchors must have the same seeds, at least one: "
            f"{sorted(points_by_seed)} and {sorted(anchors)}"
        )
    check_confidence(confidence)
    hulls = np.array([hull_at(p, grid, anchors[seed]) for seed, p in points_by_seed.items()])
    if len(hulls) == 1:
        return Band(hulls[0], None, None)
    return Band(hulls.mean(axis=0), *t_ends(hulls, confidence, (0.0, 1.0)))


def summarize_seeds(
    points: Sequence[MeasuredPoint], anchors: Mapping[int, Anchor], *, rng: np.random.Generator
) -> Summary:
    """Returns the headline numbers of a search over one or more seeds.

    Means of per-seed values, with canonical play as an anchor in each seed, except: `auc_pooled`
    and `on_frontier` are of all seeds together, with the *mean* anchor (the anchors estimate one
    number, so the largest of them would err upwards); `auc_paper_axis` is the paper's table as far
    as it can be rebuilt: pooled, linear, own discriminators' naturalness, no anchor.

    Args:
        points: All points of all seeds, re-scored. Those with too many faults count nowhere.
        anchors: Canonical play of every seed that was searched.
        rng: Resamples for the BCa intervals, which are given from 30 seeds on.

    Raises:
        ValueError: `anchors` are empty, a point's seed has none, or a sound point leaves [0, 1].
    """
    if not anchors:
        raise ValueError("anchors must name at least one seed, got none")
    seeds = sorted(anchors)
    by_seed = sound_points_by_seed(points, seeds)

    def each(measure: Callable[[Points, Anchor], float]) -> dict[str, float]:
        return {str(seed): measure(by_seed[seed], anchors[seed]) for seed in seeds}

    worst = {
        f"{level:g}": {str(seed): worst_at(by_seed[seed], level, anchors[seed]) for seed in seeds}
        for level in NATURALNESS_LEVELS
    }
    natural = each(auc_natural)
    auc = each(area_under_frontier)
    pooled = np.concatenate([by_seed[seed] for seed in seeds])
    mean_anchor = float(np.mean([anchor_height(anchor) for anchor in anchors.values()]))
    return Summary(
        worst_at={level: _mean(values) for level, values in worst.items()},
        worst_at_interval={level: _t(values) for level, values in worst.items()},
        worst_at_interval_bca={level: _bca(values, rng) for level, values in worst.items()},
        worst_at_by_seed=worst,
        auc_natural=_mean(natural),
        auc_natural_interval=_t(natural),
        auc_natural_interval_bca=_bca(natural, rng),
        auc_natural_by_seed=natural,
        auc=_mean(auc),
        auc_interval=_t(auc),
        auc_interval_bca=_bca(auc, rng),
        auc_by_seed=auc,
        auc_pooled=area_under_frontier(pooled, mean_anchor),
        auc_staircase=_mean(each(lambda p, a: area_under_frontier(p, a, kind="staircase"))),
        auc_linear=_mean(each(lambda p, a: area_under_frontier(p, a, kind="linear"))),
        auc_excess=_mean(each(auc_excess)),
        auc_paper_axis=_auc_paper_axis(points),
        on_frontier=_on_frontier(points, mean_anchor),
    )


def _on_frontier(points: Sequence[MeasuredPoint], anchor: float) -> tuple[bool, ...]:
    sound = [point for point in points if point.is_sound]
    with_canonical = np.vstack([_as_array(sound), (1.0, anchor)])
    marks = iter(non_dominated(with_canonical).tolist())
    return tuple(point.is_sound and next(marks) for point in points)


def _auc_paper_axis(points: Sequence[MeasuredPoint]) -> float | None:
    sound = [point for point in points if point.is_sound]
    own = [(p.naturalness_own, p.adversarialness) for p in sound if p.naturalness_own is not None]
    if not own or len(own) < len(sound):  # Part of the points would give another search's area.
        return None
    return area_under_frontier(own, kind="linear")


def _as_array(points: Sequence[MeasuredPoint]) -> Float[np.ndarray, "n 2"]:
    pairs = [(point.naturalness, point.adversarialness) for point in points]
    return np.array(pairs, dtype=float).reshape(-1, 2)


def _mean(by_seed: Mapping[str, float]) -> float:
    return float(np.mean(list(by_seed.values())))


def _t(by_seed: Mapping[str, float]) -> Interval | None:
    return t_interval(list(by_seed.values()))


def _bca(by_seed: Mapping[str, float], rng: np.random.Generator) -> Interval | None:
    return bca_interval(list(by_seed.values()), rng)

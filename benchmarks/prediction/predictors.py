"""The numbers that might predict: a frontier's headline, and the same from redrawn search seeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.frontier.intervals import Interval
from rigid.frontier.result import measured_points
from rigid.frontier.statistics import NATURALNESS_LEVELS, MeasuredPoint, summarize_seeds

HEADLINES = (
    *(f"worst_at_{level:g}" for level in NATURALNESS_LEVELS),
    "auc_natural",
    "auc",
    "auc_excess",
    "auc_paper_axis",
)
"""Fields of `frontier.json`; `worst_at_0.9` is `worst_at` of "0.9"."""
WITH_INTERVAL = (*HEADLINES[:4], "auc")
"""Headline numbers that `frontier.json` states an interval for."""
BASELINE = "canonical"
"""Adversarialness with the human that the robot was trained for: a number that needs no search."""
PREDICTORS = (*HEADLINES, BASELINE)


def numbers_of(frontier: Mapping[str, Any]) -> dict[str, float]:
    """Every predictor of a robot from its `frontier.json`; NaN where it is undefined."""
    canonical = {BASELINE: frontier["canonical"]["adversarialness"]}
    return {**_headline(frontier), **canonical}


def interval_of(frontier: Mapping[str, Any], name: str) -> Interval | None:
    """The 95 % interval over search seeds of one of `WITH_INTERVAL`; None for one seed."""
    kind, _, level = name.rpartition("_")
    at_level = kind == "worst_at"
    ends = frontier["worst_at_interval"][level] if at_level else frontier[f"{name}_interval"]
    return None if ends is None else Interval(*ends)


def redrawn(
    frontier: Mapping[str, Any], draws: int, rng: np.random.Generator
) -> dict[str, Float[np.ndarray, " draws"]]:
    """Every predictor of a robot, again and again from search seeds drawn with replacement.

    The estimator itself on the drawn seeds, so that pooled numbers are redrawn as they are pooled.
    S seeds that are redrawn show (S - 1) / S of the variance that S fresh seeds would have. The
    baseline has no seeds and stays.
    """
    points = measured_points(frontier["points"])
    seeds = sorted(int(seed) for seed in frontier["auc_by_seed"])
    anchor = frontier["canonical"]["adversarialness"]
    drawn = [tuple(sorted(row)) for row in rng.choice(seeds, size=(draws, len(seeds))).tolist()]
    known = {row: _of_seeds(points, row, anchor) for row in sorted(set(drawn))}
    columns = {name: np.array([known[row][name] for row in drawn]) for name in HEADLINES}
    return {**columns, BASELINE: np.full(draws, float(anchor))}


def _of_seeds(
    points: list[MeasuredPoint], drawn: tuple[int, ...], anchor: float
) -> dict[str, float]:
    """The headline of a search with exactly these seeds; the same one may stand there twice."""
    relabelled = [
        replace(point, seed=place)
        for place, seed in enumerate(drawn)
        for point in points
        if point.seed == seed
    ]
    anchors = dict.fromkeys(range(len(drawn)), anchor)
    # From 30 seeds on the summary draws for its own intervals, which nobody reads here.
    summary = summarize_seeds(relabelled, anchors, rng=np.random.default_rng(0))
    return _headline(summary.headline())


def _headline(block: Mapping[str, Any]) -> dict[str, float]:
    named = {f"worst_at_{level}": value for level, value in block["worst_at"].items()}
    found = {name: named.get(name, block.get(name)) for name in HEADLINES}
    return {name: np.nan if value is None else float(value) for name, value in found.items()}

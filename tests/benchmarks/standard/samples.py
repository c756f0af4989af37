"""Measurements with points set by hand: of each seed sabotage, and one natural attack."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from benchmarks.standard.pairing import pairs_of, table_rows, with_pooled
from rigid.frontier.result import Frontier
from rigid.frontier.statistics import MeasuredPoint, summarize_seeds

NATURAL = 0.9
"""Naturalness of the attack."""


def frontier(heights, *, natural=NATURAL, core_seconds=100.0, env_steps=1000):
    """A measurement whose seeds found (0, 1) and (`natural`, their height); canonical play is 0.

    With a height h of 0.1 or more at naturalness 0.9 its `auc` is 0.45 + h / 2.
    """
    places = [
        MeasuredPoint(f"s{seed}-r1-l{number}", seed, x, x, y, 0.0)
        for seed, height in heights.items()
        for number, (x, y) in enumerate([(0.0, 1.0), (natural, height)], 1)
    ]
    summary = summarize_seeds(places, dict.fromkeys(heights, 0.0), rng=np.random.default_rng(0))
    data = {
        "schema": 1, "task": "itch-scratching", "robot": "builtin:vanilla", "preset": "planted",
        "canonical": {
            "success": 0.98, "return": 450.0, "adversarialness": 0.0, "episodes": 40,
            "source": "synthetic",
        },
        "points": [_entry(place) for place in places], **summary.headline(),
        "return_range": [-270.0, 450.0], "env_steps": env_steps * len(heights),
        "env_steps_scoring": 10 * len(heights), "core_seconds": core_seconds * len(heights),
        "wall_seconds": 1.0,
    }  # fmt: skip
    return Frontier(Path("nowhere"), json.loads(json.dumps(data)))


def _entry(place):
    return {
        "id": place.id, "seed": place.seed, "round": 1, "lambda": 0.1,
        "naturalness": place.naturalness, "naturalness_own": place.naturalness,
        "naturalness_all": {}, "adversarialness": place.adversarialness, "return": 0.0,
        "success": 0.5, "episodes": 100, "outcomes": {}, "peak_force": None, "impulse": None,
        "faults": 0, "converged": True, "on_frontier": True,
    }  # fmt: skip


def each(heights, **options):
    """A measurement for each seed."""
    return {seed: frontier({seed: height}, **options) for seed, height in heights.items()}


def rows_of(measured):
    """The table of measurements by robot, preset and seed."""
    return table_rows(
        with_pooled([p for name, runs in measured.items() for p in pairs_of(name, runs)])
    )


def both(standard, paper, **options):
    """Measurements of a robot by preset and seed, from heights by seed."""
    return {"standard": each(standard, **options), "paper": each(paper, **options)}

"""A made-up study: robots whose headline and failures are given, without any training."""

from __future__ import annotations

import numpy as np

from benchmarks.prediction.assembling import Subject
from benchmarks.prediction.plan import HumanPlan
from benchmarks.prediction.predictors import numbers_of, redrawn
from benchmarks.robots import RobotPlan
from rigid.frontier.statistics import MeasuredPoint, summarize_seeds

HUMANS = (
    HumanPlan(name="pair-1", group="pairs", seed=100, pair=1),
    HumanPlan(name="female", group="bodies", seed=101, changes={"body": "female"}),
    HumanPlan(name="tremor-1", group="impairments", seed=102, changes={"impairment": "tremor"}),
)


def frontier(points, *, canonical=0.05, success=1.0):
    """What `frontier.json` says of points (seed, naturalness, own naturalness, adversarialness)."""
    measured = [
        MeasuredPoint(f"s{seed}-r1-l{i}", seed, x, own, y, 0.0)
        for i, (seed, x, own, y) in enumerate(points)
    ]
    anchors = dict.fromkeys(sorted({point.seed for point in measured}), canonical)
    summary = summarize_seeds(measured, anchors, rng=np.random.default_rng(0))
    listed = [
        {
            "id": point.id, "seed": point.seed, "naturalness": point.naturalness,
            "naturalness_own": point.naturalness_own, "adversarialness": point.adversarialness,
            "faults": 0, "episodes": 100,
        }
        for point in measured
    ]  # fmt: skip
    return {
        "points": listed,
        "canonical": {"adversarialness": canonical, "success": success},
        "return_range": [-270.0, 450.0],
        **summary.headline(),
    }


def meeting(adversarialness, *, success=0.5, episodes=100, faults=0, std=72.0):
    """What `evaluate` says of a robot with a human."""
    return {
        "adversarialness": adversarialness, "success": success, "episodes": episodes,
        "faults": faults, "return": 0.0, "return_std": std,
    }  # fmt: skip


def subject(place, headline, failure, *, success=1.0, canonical=0.05, natural=True):
    """A robot whose `worst_at` is `headline` if it is `natural`, and who fails by `failure`."""
    x = 0.97 if natural else 0.1
    found = frontier(
        [(0, x, x, headline), (1, x, x, headline)], canonical=canonical, success=success
    )
    return Subject(
        plan=RobotPlan(iterations=6, seed=place),
        frontier=found,
        numbers=numbers_of(found),
        redrawn=redrawn(found, 20, np.random.default_rng(place)),
        meetings={human.name: meeting(failure, success=1 - failure) for human in HUMANS},
    )

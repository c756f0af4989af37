"""Whole measurements whose seeds found one human each, at naturalness 0.9."""

from __future__ import annotations

import json
from pathlib import Path

from rigid.frontier.result import Frontier

IDENTITY = {"task": {"name": "reach"}, "preset": {"iterations": 40}, "human": "h0", "robot": "r0"}


def data_of(heights, *, success=1.0, **changes):
    """`frontier.json`: adversarialness of the human at naturalness 0.9, by seed; canonical is 0."""
    points = [
        {
            "id": f"s{seed}-r1-l1", "seed": seed, "round": 1, "lambda": 0.1, "naturalness": 0.9,
            "naturalness_own": None, "naturalness_all": {}, "adversarialness": height,
            "return": 0.0, "success": 0.5, "episodes": 100, "outcomes": {}, "peak_force": None,
            "impulse": None, "faults": 0, "converged": True, "on_frontier": True,
        }
        for seed, height in heights.items()
    ]  # fmt: skip
    canonical = {
        "success": success, "return": 1.0, "adversarialness": 0.0, "episodes": 50,
        "source": "synthetic",
    }  # fmt: skip
    return {
        "schema": 1, "task": "reach", "robot": "builtin:vanilla", "human": "builtin:human",
        "preset": "planted", "canonical": canonical, "points": points, "worst_at": {},
        "worst_at_interval": {}, "auc_natural": 0.5, "auc": 0.5, "auc_interval": None,
        "auc_by_seed": {str(seed): 0.5 for seed in heights}, "return_range": [-1.0, 1.0],
        "env_steps": 1, "core_seconds": 1.0, "wall_seconds": 1.0, **changes,
    }  # fmt: skip


def measured(heights, *, human="h0", directory="run", **changes):
    """A measurement and its identity."""
    return Frontier(Path(directory), data_of(heights, human=human, **changes)), {
        **IDENTITY,
        "human": human,
    }


def store(directory, heights, *, human="h0", identity=None, **changes):
    """The same as a run directory, as far as a comparison looks."""
    directory.mkdir(parents=True)
    settings = {
        "schema": 1, "seeds": list(heights), "provenance": {"versions": {}},
        "identity": {**IDENTITY, "human": human, **(identity or {})},
    }  # fmt: skip
    (directory / "settings.json").write_text(json.dumps(settings))
    (directory / "frontier.json").write_text(json.dumps(data_of(heights, human=human, **changes)))
    return directory

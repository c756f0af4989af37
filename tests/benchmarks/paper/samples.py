"""Frontiers set by hand, as the studies keep them, and a plan that nobody runs."""

from __future__ import annotations

from benchmarks.paper.plan import full_plan
from rigid.files import json_text
from rigid.presets import PRESETS
from tests.benchmarks.standard.samples import frontier

PLAN = full_plan(PRESETS["standard"], (0, 1))


def keep(places, name, seed, heights, **options):
    """A frontier whose natural attack has these heights, by search seed."""
    place = places.kept_run(name, seed)
    place.mkdir(parents=True)
    data = dict(frontier(heights, **options).data)
    (place / "frontier.json").write_text(json_text(data))
    settings = {"schema": 1, "identity": {}, "seeds": [], "provenance": {"versions": {}}}
    (place / "settings.json").write_text(json_text(settings))


def played(robot, robot_seed, human_seed, success, human="human"):
    """A row of the cross-play matrix."""
    return {
        "robot": robot, "robot_seed": robot_seed, "human": human, "human_seed": human_seed,
        "success": success, "return": 0.0, "episodes": 100,
    }  # fmt: skip

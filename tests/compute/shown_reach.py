"""The toy task with a picture, and toy runs whose points stand where a test wants them."""

from __future__ import annotations

import json

import numpy as np

from rigid.compute.run.checkpoint import load_arrays, save_arrays
from rigid.tasks import registry
from tests.compute.tiny import FilmedReach

ROBOT, HAND = 1, 2


class ShownReach(FilmedReach):
    """`FilmedReach`, drawn: a robot and a hand on a line."""

    def scene(self):
        geoms = [{"body": ROBOT, "role": "robot"}, {"body": HAND, "role": "human"}]
        return {"bodies": ["world", "robot", "hand"], "geoms": geoms}

    def replay(self, snapshots):
        poses = np.zeros((len(snapshots), 2, 7))
        poses[:, :, 0] = snapshots[:, :2]
        return {"frames": len(snapshots), "bodies": [ROBOT, HAND], "poses": poses}


def count_as_rigids_own(monkeypatch):
    """Lets the toy task be found by its description."""
    recipe = registry._Recipe(ShownReach, None)
    monkeypatch.setitem(registry._BUILTIN, "toy-reach", lambda: recipe)


def put(run, **places):
    """Moves points of a run to (naturalness, adversarialness of the worst, of the median one).

    All episodes that are kept begin with the goal at +1.
    """
    path = run / "frontier.json"
    data = json.loads(path.read_text(encoding="utf-8"))
    seeds = goal_seeds(+1.0, 2 * len(data["points"]))
    for number, point in enumerate(data["points"]):
        x, *heights = places.get(point["id"].replace("-", "_"), (0.5, 0.5, 0.5))
        point["naturalness"] = x
        kept = run / "adversaries" / point["id"] / "episodes.npz"
        arrays = load_arrays(kept, cure="")
        arrays["shown"] = np.array([0, 1])
        arrays["faulted"][:2] = 0
        arrays["seeds"][:2] = seeds[2 * number : 2 * number + 2]
        worst, best = data["return_range"]
        arrays["returns"][:2] = [best - y * (best - worst) for y in heights]
        save_arrays(kept, arrays)
    path.write_text(json.dumps(data), encoding="utf-8")


def goal_seeds(goal, count):
    """Seeds of starts with the goal there."""
    seeds = (s for s in range(1000) if np.random.default_rng(s).choice([-1.0, 1.0]) == goal)
    return [next(seeds) for _ in range(count)]

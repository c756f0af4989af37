"""Assistive Gym's speed beside ours, per core: `rigid bench --assistive-gym`.

Its figures were measured elsewhere and not in this run, so that the ratio to them is of two
machines. They are of ScratchItchJacoHuman-v1 at Healthcare-Robotics/assistive-gym fb799c3, with
PyBullet 3.2.7 under Python 3.11: headless, uniform actions in ±0.1, control at 10 Hz (five physics
steps of 0.02 s), one process on one core of a 2.6 GHz Xeon that others used as well, in November
2026. Steps for each second of processor time, median of three runs: 255 (254.8, 255.1, 283.7) of
stepping alone, over 20 s or more; 39 (29.1, 39.2, 65.2) with the resets of 100-step episodes, over
60 s, since its inverse kinematics may restart a thousand times.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from rigid.compute.speed.timing import spread_of
from rigid.tasks.itch_scratching.task import ItchScratching

THEIRS = {"stepping": 255.0, "with_resets": 39.0}
"""Environment steps for each second of one core; see above."""
_WORLDS = 48
"""Episodes side by side: those of one adversary in preset `paper`."""
_LARGEST_ACTION = 0.1  # As in their runs.


def beside_assistive_gym(repeats: int, task: ItchScratching | None = None) -> dict[str, Any]:
    """Our environment steps for each second of one core, and how many times theirs that is.

    One step is what `World.step` does: physics, observation, reward and features, with no policy.

    Args:
        repeats: Sets of episodes that count; one more comes first.
        task: Itch scratching; the default one where it is None.
    """
    task = task or ItchScratching()
    found = np.array([_one_set(task, seed) for seed in range(repeats + 1)][1:])
    stepping, resets = found.T
    steps = _WORLDS * task.horizon
    ours = {"stepping": steps / stepping, "with_resets": steps / (stepping + resets)}
    rows = {}
    for name, rates in ours.items():
        spread = spread_of(rates.tolist())
        rows[name] = {
            "ours": round(spread.median),
            "spread": [round(spread.low), round(spread.high)],
            "theirs": THEIRS[name],
            "ratio": round(spread.median / THEIRS[name], 1),
        }
    period = task.parameters.physics_step * task.parameters.substeps
    return {"control_hz": round(1 / period, 3), "theirs_measured_in_this_run": False, **rows}


def _one_set(task: ItchScratching, seed: int) -> tuple[float, float]:
    """Processor time [s] of the steps and of the reset of one set of episodes, on one thread."""
    rng = np.random.default_rng(seed)
    world = task.make_world(_WORLDS, threads=1)
    actions = [
        rng.uniform(-_LARGEST_ACTION, _LARGEST_ACTION, (task.horizon, _WORLDS, agent.action_size))
        for agent in (task.robot, task.human)
    ]
    begun = time.process_time()
    world.reset(rng.integers(2**31, size=_WORLDS))
    between = time.process_time()
    for robot, human in zip(*actions, strict=True):
        world.step(robot, human)
    return time.process_time() - between, between - begun

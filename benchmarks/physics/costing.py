"""What a finer step costs: whole environment steps with ready actions, timed in turns."""

from __future__ import annotations

import time
from collections.abc import Mapping

import numpy as np
from jaxtyping import Int

from benchmarks.physics.plan import DEFAULT, SETTINGS, Plan
from benchmarks.physics.playing import play_block, starts_of, task_at
from rigid.learning.rollout import Trajectories
from rigid.tasks.protocol import World

_WORLDS = 48
"""Side by side, as in an adversary's training (paper preset)."""
_BLOCK = 2_000_000
"""Block of the recorded actions: none of the other parts'. Ours."""


def costs(plan: Plan) -> dict[str, list[float]]:
    """Processor time of an environment step over that of the task's setting, in each turn.

    Simulation, contacts, reward and observations on one thread; no policy. In every turn all
    settings take the same actions from the same starts one after the other, so that whatever
    else the machine does meets all of them.
    """
    recorded = play_block("canonical", DEFAULT, count=_WORLDS, seed=plan.seed, block=_BLOCK)
    starts, _ = starts_of(_WORLDS, seed=plan.seed, block=_BLOCK)
    worlds = {one.name: task_at(one).make_world(_WORLDS, threads=1) for one in SETTINGS}
    spent = [
        _turn(worlds, starts, recorded.episodes, plan.turn_steps) for _ in range(plan.turns + 1)
    ]
    return {
        one.name: [turn[one.name] / turn[DEFAULT.name] for turn in spent[1:]]  # The first warms up.
        for one in SETTINGS
    }


def _turn(
    worlds: Mapping[str, World], starts: Int[np.ndarray, " B"], actions: Trajectories, steps: int
) -> dict[str, float]:
    seconds = {}
    for name, world in worlds.items():
        world.reset(starts)
        begun = time.process_time()
        for number in range(steps):
            world.step(actions.robot_action[number], actions.human_action[number])
        seconds[name] = time.process_time() - begun
    return seconds

"""Feeding under PettingZoo's names.

Example:
    >>> from rigid.tasks import feeding_v0
    >>> world = feeding_v0.parallel_env(body="female")
    >>> observations, infos = world.reset(seed=0)
    >>> {agent: seen.shape for agent, seen in observations.items()}
    {'robot': (25,), 'human': (23,)}
"""

from __future__ import annotations

from typing import Any

from pettingzoo.utils.conversions import parallel_to_aec
from pettingzoo.utils.env import AECEnv

from rigid.tasks.registry import make_task
from rigid.tasks.views.pettingzoo import TwoPlayerEnv


def parallel_env(**parameters: Any) -> TwoPlayerEnv:
    """Both players act at once; the keywords are those of `FeedingParameters`.

    Raises:
        UserError: Unknown parameter or bad value.
    """
    return TwoPlayerEnv(make_task("feeding", **parameters))


def env(**parameters: Any) -> AECEnv:
    """The same, one player at a time: the world moves once both have acted.

    Raises:
        UserError: Unknown parameter or bad value.
    """
    return parallel_to_aec(parallel_env(**parameters))

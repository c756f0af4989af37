"""Bed bathing under PettingZoo's names.

Example:
    >>> from rigid.tasks import bed_bathing_v0
    >>> world = bed_bathing_v0.parallel_env(body="female")
    >>> observations, infos = world.reset(seed=0)
    >>> {agent: seen.shape for agent, seen in observations.items()}
    {'robot': (24,), 'human': (28,)}
"""

from __future__ import annotations

from typing import Any

from pettingzoo.utils.conversions import parallel_to_aec
from pettingzoo.utils.env import AECEnv

from rigid.tasks.registry import make_task
from rigid.tasks.views.pettingzoo import TwoPlayerEnv


def parallel_env(**parameters: Any) -> TwoPlayerEnv:
    """Both players act at once; the keywords are those of `BedBathingParameters`.

    Raises:
        UserError: Unknown parameter or bad value.
    """
    return TwoPlayerEnv(make_task("bed-bathing", **parameters))


def env(**parameters: Any) -> AECEnv:
    """The same, one player at a time: the world moves once both have acted.

    Raises:
        UserError: Unknown parameter or bad value.
    """
    return parallel_to_aec(parallel_env(**parameters))

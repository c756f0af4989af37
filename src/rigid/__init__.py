"""RIGID: how robust is an assistive robot to the way people really move?

This module is the whole public interface; everything is imported when it is first used, so that
`import rigid` stays fast.
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

from rigid._version import __version__
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.api import measure
    from rigid.data.episodes import CanonicalEpisodes, load_episodes, save_episodes
    from rigid.frontier.curve import area_under_frontier
    from rigid.frontier.largest_jump import largest_jump
    from rigid.frontier.result import Frontier, load_frontier
    from rigid.policies.loading import load_policy
    from rigid.policies.opening import Opening
    from rigid.policies.protocol import Policy
    from rigid.tasks.protocol import Task
    from rigid.tasks.registry import make_task
    from rigid.tasks.views.gymnasium import SinglePlayerEnv

__all__ = [
    "CanonicalEpisodes",
    "Frontier",
    "Opening",
    "Policy",
    "SinglePlayerEnv",
    "Task",
    "UserError",
    "__version__",
    "area_under_frontier",
    "largest_jump",
    "load_episodes",
    "load_frontier",
    "load_policy",
    "make_task",
    "measure",
    "save_episodes",
]

_HOMES = {
    "CanonicalEpisodes": "rigid.data.episodes",
    "Frontier": "rigid.frontier.result",
    "Opening": "rigid.policies.opening",
    "Policy": "rigid.policies.protocol",
    "SinglePlayerEnv": "rigid.tasks.views.gymnasium",
    "Task": "rigid.tasks.protocol",
    "area_under_frontier": "rigid.frontier.curve",
    "largest_jump": "rigid.frontier.largest_jump",
    "load_episodes": "rigid.data.episodes",
    "load_frontier": "rigid.frontier.result",
    "load_policy": "rigid.policies.loading",
    "make_task": "rigid.tasks.registry",
    "measure": "rigid.api",
    "save_episodes": "rigid.data.episodes",
}


if "gymnasium" in sys.modules:
    # Gymnasium has no entry points for environments. Importing it here would cost every command a
    # third of a second, so its users get the registration: they import it before they make one.
    from rigid.tasks.views.gymnasium import register

    register()


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'rigid' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

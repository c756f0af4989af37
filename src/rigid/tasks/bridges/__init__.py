"""Tasks of other people's making: their environments, played as RIGID's two-player worlds.

Of this only `HumanPort` is for them; docs/tasks.md says how an environment becomes a task.
"""

from __future__ import annotations

from typing import Any

__all__ = ["HumanPort"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'rigid.tasks.bridges' has no attribute {name!r}")
    from rigid.tasks.bridges.gymnasium import HumanPort  # Not before Gymnasium is wanted.

    return HumanPort

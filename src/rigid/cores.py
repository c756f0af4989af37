"""The cores of this machine that are ours to use."""

from __future__ import annotations

import os


def cores() -> list[int]:
    """The cores that this process may use, by number where the system numbers them."""
    if hasattr(os, "sched_getaffinity"):
        return sorted(os.sched_getaffinity(0))
    return list(range(os.cpu_count() or 1))

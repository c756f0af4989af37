"""The cores of this machine that are ours to use."""

from __future__ import annotations

import os
from pathlib import Path


def cores() -> list[int]:
    """The cores that this process may use, by number where the system numbers them."""
    if hasattr(os, "sched_getaffinity"):
        return sorted(os.sched_getaffinity(0))
    return list(range(os.cpu_count() or 1))


_helpers = set[int]()
"""Processes that this one has started to work for it, and that still live: its operating system
counts the time of a child only once it has ended."""


def count_helper(pid: int) -> None:
    """From now on the processor time of this child belongs to `helper_seconds`."""
    _helpers.add(pid)


def helper_seconds() -> float:
    """Processor time of those helpers that live, and of what they started [s].

    Where the system has no `/proc`, 0: then the time of a helper counts when it ends.
    """
    spent = {pid: _seconds(pid) for pid in _helpers}
    _helpers.difference_update(pid for pid, seconds in spent.items() if seconds is None)
    return sum(seconds for seconds in spent.values() if seconds is not None)


def _seconds(pid: int) -> float | None:
    """Of a process and its ended children [s]; None where there is none such."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return None
    # utime, stime, cutime, cstime: fields 14 to 17 of proc(5), of which two stood before the name.
    return sum(int(ticks) for ticks in fields[11:15]) / os.sysconf("SC_CLK_TCK")

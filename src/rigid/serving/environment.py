"""Where child processes import from: never from the folder in which RIGID happens to be run.

Workers are started as `python -m …`, which puts the working directory before everything that is
installed: a `cloudpickle.py` in a stranger's folder would run. Programs of the user's own are
another matter, and import as they always do.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, MutableMapping

_VARIABLE, _OURS = "PYTHONSAFEPATH", "rigid"
"""Python asks only whether it is set, so that the value can say who did it."""


def shut_working_directory(environment: MutableMapping[str, str] = os.environ) -> None:
    """Keeps the working directory off the module search path of Pythons that are started from here.

    For the command line alone: what a program that uses RIGID as a library starts is its own.
    """
    if not environment.get(_VARIABLE):
        environment[_VARIABLE] = _OURS


def for_programs(environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """The environment as the user has it, for programs that the user names."""
    found = dict(environment)
    if found.get(_VARIABLE) == _OURS:
        del found[_VARIABLE]
    return found

"""What MuJoCo warns of is said once in a process, not once for each of hundreds of environments."""

from __future__ import annotations

import re
import sys

import mujoco

_NUMBER = re.compile(r"[-+.\d]+(e[-+]?\d+)?")


def warn_once() -> None:
    """From now on MuJoCo's warnings go to standard error, each once, and into no log file.

    Warnings that differ in their numbers alone, such as the time of a fault, are one. A handler
    that somebody else has set stays.
    """
    if mujoco.get_mju_user_warning() is None:
        known = set[str]()

        def say(text: str) -> None:
            kind = _NUMBER.sub("#", text)
            if kind not in known:
                known.add(kind)
                sys.stderr.write(f"MuJoCo: {text}\n")

        mujoco.set_mju_user_warning(say)

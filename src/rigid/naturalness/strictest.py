"""How natural is a human whom no referee was trained for? At most as the strictest stored one says.

A referee was trained for one adversary, but for any fixed f the expectation of

    min(1, P_q[f < 0] + κ P_p[f ≥ 0])

is, before clipping, at least the true overlap of the law q of *whoever* moves with the canonical
law p (`rigid.naturalness.referee`). So every stored referee gives an upper bound, and the least one
is the tightest. It is chosen on one half of the episodes and asked on the other: the least of many
on the same episodes would be too low by chance.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from rigid.naturalness.panel import AXIS, Panel, naturalness
from rigid.naturalness.views import Episodes

_LEVEL = AXIS.partition("_k")[0]


class UpperBound(NamedTuple):
    """How natural a human is at most, on the x axis of the frontier."""

    naturalness: float
    se: float | None
    """Standard error over episodes; None where one episode was asked about."""
    referee: int
    """Place of the strictest referee."""


def strictest_naturalness(panels: Sequence[Panel], episodes: Episodes) -> UpperBound:
    """An upper bound on the naturalness of one human, by the strictest of many referees.

    Episodes of even number, from 0, choose the referee, and those of odd number are judged: both
    halves then see a person who learns from episode to episode alike (ours).

    Args:
        panels: Referees that judged adversaries against the same canonical motion.
        episodes: Of this human with that robot; at least two.

    Raises:
        ValueError: There are fewer than two episodes, or a half without a sound step, or no
            referee.
    """
    if len(episodes.features) < 2:
        raise ValueError("one half of the episodes chooses the referee: at least 2 are needed")
    choosing, judged = (episodes.part(slice(first, None, 2)) for first in (0, 1))
    if not (choosing.sound.any() and judged.sound.any()):
        raise ValueError("one half of the episodes ran away from the beginning")
    steps = {n: {_LEVEL: panel[_LEVEL]} for n, panel in enumerate(panels) if _LEVEL in panel}
    if not steps:
        raise ValueError("there is no referee of single steps")
    levels = {n: naturalness(panel, choosing)[AXIS] for n, panel in steps.items()}
    known = {n: level.value for n, level in levels.items() if level is not None}
    strictest = min(known, key=lambda n: known[n])
    found = naturalness(steps[strictest], judged)[AXIS]
    assert found is not None  # Its half has a sound step.
    return UpperBound(found.value, found.se, strictest)

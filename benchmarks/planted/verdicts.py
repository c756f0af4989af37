"""From judged humans to verdicts: what was found, what was a false alarm, and who found more."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.planted.arena import Judgement
from rigid.frontier.intervals import Interval, t_interval

HALF = 0.5
"""A weakness counts as found where it shows in at least so many episodes of one human."""
MARGIN = 0.1
"""By so much a human may be less natural than the weakness truly is."""

Part = Mapping[str, Any]
"""One robot with one seed, as it is kept: truth, anchor, replays, and the humans of each method."""


def judgements(entries: Sequence[Mapping[str, float]]) -> list[Judgement]:
    """Judgements as they are kept in a part."""
    return [Judgement(**entry) for entry in entries]


def found(humans: Sequence[Judgement], true_naturalness: float) -> bool:
    """Whether one of the humans shows the weakness, and is nearly as natural as it can be.

    Example:
        >>> humans = [Judgement(0.9, 0.1, 0.2, 0.2), Judgement(0.62, 0.6, 0.9, 0.9)]
        >>> found(humans, 0.7), found(humans, 0.8)
        (True, False)
    """
    return any(
        human.shown >= HALF and human.naturalness >= true_naturalness - MARGIN for human in humans
    )


def alarm(humans: Sequence[Judgement], true_naturalness: float) -> bool:
    """Whether a decoy is accused: a human as natural who misses the robot in half of its episodes.

    The decoy bears what its twin cannot bear, and is held to the same naturalness.
    """
    return any(
        human.missed >= HALF and human.naturalness >= true_naturalness - MARGIN for human in humans
    )


def advantage(
    mine: Mapping[str, Sequence[bool]], theirs: Mapping[str, Sequence[bool]]
) -> tuple[float, Interval | None]:
    """How many more of the weaknesses, as a share, and its 95 % t interval over weaknesses.

    Args:
        mine: By weakness, whether each seed found it.
        theirs: Of the rival; the same weaknesses.
    """
    differences = [
        sum(mine[name]) / len(mine[name]) - sum(theirs[name]) / len(theirs[name]) for name in mine
    ]
    return sum(differences) / len(differences), t_interval(differences, bounds=(-1.0, 1.0))

"""Shares of helped episodes over robots of one method, with an interval that knows of both.

Ours; the paper's table gives success without an interval.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from statistics import fmean
from typing import NamedTuple

from scipy.stats import binomtest

from rigid.frontier.intervals import Interval, t_interval


class Played(NamedTuple):
    """What a robot achieved with one human."""

    robot: int
    """Which robot of its method."""
    success: float
    """Share of its episodes, in [0, 1]."""
    episodes: int


@dataclass(frozen=True)
class Success:
    """A share of episodes with its 95 % interval."""

    mean: float
    interval: Interval


def success_of(played: Iterable[Played]) -> Success | None:
    """Mean over robots of their mean over humans; None where nothing was played.

    The interval is the wider, at each end, of Wilson's over all episodes and Student's over robots:
    with few robots either alone promises too much, the one since robots differ, the other since
    robots that all succeed seem not to. It is about the humans who were met and no others.

    Args:
        played: Each robot with each of its humans.

    Raises:
        ValueError: A share leaves [0, 1] or has no episodes.

    Example:
        >>> found = success_of([Played(0, 1.0, 100), Played(1, 0.9, 100)])
        >>> round(found.mean, 2), round(found.interval.low, 2), round(found.interval.high, 2)
        (0.95, 0.31, 1.0)
    """
    by_robot: dict[int, list[float]] = {}
    episodes = 0
    for one in played:
        if not 0.0 <= one.success <= 1.0 or one.episodes < 1:
            raise ValueError(f"success must be a share of at least one episode, got {one}")
        by_robot.setdefault(one.robot, []).append(one.success)
        episodes += one.episodes
    if not by_robot:
        return None
    robots = [fmean(shares) for shares in by_robot.values()]
    mean = fmean(robots)
    wilson = binomtest(round(mean * episodes), episodes).proportion_ci(method="wilson")
    ends = [Interval(float(wilson.low), float(wilson.high))]
    over_robots = t_interval(robots)
    if over_robots is not None:
        ends.append(over_robots)
    return Success(mean, Interval(min(e.low for e in ends), max(e.high for e in ends)))

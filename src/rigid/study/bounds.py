"""How many players it takes to say that few people lie above the frontier.

That 0 of 8 do (paper, section 5.2) leaves 31 % possible. Players are counted, not episodes: those
of one player are no independent draws.
"""

from __future__ import annotations

from typing import NamedTuple

from scipy.special import bdtr

from rigid.study.analysis.dominance import share

_MOST = 100_000
"""Players; more is no study."""


class Chance(NamedTuple):
    """What a number of players can show."""

    players: int
    at_most_if_none: float
    """Upper bound of the share above the frontier where none of them lies above."""
    allowed: int | None
    """How many of them may lie above, so that the bound is kept; None: not even none."""
    chance: float
    """That no more do."""


def upper_bound(count: int, players: int, confidence: float = 0.95) -> float:
    """The largest share that `count` of `players` leaves possible, as `rigid study analyze` has it.

    Example:
        >>> round(upper_bound(0, 8), 2)
        0.31
    """
    bound = share([True] * count + [False] * (players - count), confidence).at_most
    assert bound is not None
    return bound


def players_needed(count: int, at_most: float, confidence: float = 0.95) -> int | None:
    """The fewest players of whom `count` above the frontier leave at most a share of `at_most`.

    Returns:
        None where a hundred thousand are too few.

    Example:
        >>> players_needed(0, 0.05), players_needed(1, 0.05)
        (59, 93)
    """
    low, high = count, count + 1
    while upper_bound(count, high, confidence) > at_most:
        low, high = high, 2 * high
        if high > _MOST:
            return None
    while high - low > 1:
        middle = (low + high) // 2
        if upper_bound(count, middle, confidence) > at_most:
            low = middle
        else:
            high = middle
    return high


def chance(players: int, *, at_most: float, above: float, confidence: float = 0.95) -> Chance:
    """What `players` can show, if a share of `above` of all people truly lies above the frontier.

    Example:
        >>> found = chance(60, at_most=0.1, above=0.01)
        >>> found.allowed, round(found.chance, 2)
        (1, 0.88)
    """
    none = upper_bound(0, players, confidence)
    allowed = None
    if none <= at_most:
        allowed = 0
        while allowed + 1 < players and upper_bound(allowed + 1, players, confidence) <= at_most:
            allowed += 1
    kept = 0.0 if allowed is None else float(bdtr(allowed, players, above))
    return Chance(players, none, allowed, kept)


def smallest_for(
    power: float, *, at_most: float, above: float, confidence: float = 0.95
) -> Chance | None:
    """The smallest numbers of players with a chance of at least `power`.

    Numbers at which one more player may lie above are the only ones where the chance rises.

    Returns:
        None where no number up to a hundred thousand has it, as where `above` is not below
        `at_most`.
    """
    if above >= at_most:
        return None
    for allowed in range(1000):
        players = players_needed(allowed, at_most, confidence)
        if players is None:
            return None
        kept = float(bdtr(allowed, players, above))
        if kept >= power:
            return Chance(players, upper_bound(0, players, confidence), allowed, kept)
    return None

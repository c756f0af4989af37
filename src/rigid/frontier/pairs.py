"""Which two episodes people are shown side by side: alike on one axis of the frontier.

Paper, appendix 'Additional User Study to Verify the Natural-Adversarial Curve': pairs that differ
by less than 0.1 in naturalness and by more than 0.3 in adversarialness, and the reverse. Section
5.2, 'Faithfulness': an episode that RIGID found and a person's of the same naturalness.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

Kind = Literal["danger", "naturalness", "faithfulness"]
Axis = Literal["naturalness", "adversarialness"]

ALIKE_BELOW, DIFFERENT_ABOVE = 0.1, 0.3
"""Paper, appendix 'Additional User Study …'. That episodes are 'of the same naturalness' (section
5.2) is held to the first of them as well (ours: the paper states no number there)."""
TRIES = 32
"""Draws of which the largest counts, where episodes are too few for one that is large enough. Ours:
a draw that goes wrong may end with half of the pairs that there are."""


@dataclass(frozen=True, kw_only=True)
class Rule:
    """What makes two episodes a pair; both differences are strict."""

    alike: Axis
    """They differ by less than `alike_below` on this axis,"""
    alike_below: float = ALIKE_BELOW
    different: Axis | None
    """and by more than `different_above` on this one, if any."""
    different_above: float = DIFFERENT_ABOVE
    recorded_with_found: bool = False
    """Whether one is recorded and the other one found by the search."""


RULES: dict[Kind, Rule] = {
    "danger": Rule(alike="naturalness", different="adversarialness"),
    "naturalness": Rule(alike="adversarialness", different="naturalness"),
    "faithfulness": Rule(alike="naturalness", different=None, recorded_with_found=True),
}


class Candidates(NamedTuple):
    """Episodes that may be shown, as arrays over them.

    A pair never leaves its run: only there were both judged against the same canonical motion.
    """

    naturalness: Float[np.ndarray, " n"]
    """Of the human. Episodes have none of their own: it is a share of all that a human does."""
    adversarialness: Float[np.ndarray, " n"]
    """Of the episode."""
    run: Int[np.ndarray, " n"]
    """Whose robot it is, and whose referees judged."""
    human: Int[np.ndarray, " n"]
    """Who moved. Two episodes of one human are no pair: they are equally natural by definition."""
    start: Int[np.ndarray, " n"]
    """What the human starts from; a pair shares it, so that one reference serves both."""
    recorded: Bool[np.ndarray, " n"]
    """Whether it was recorded, and not found by the search."""
    episode: Int[np.ndarray, " n"]
    """Which episode it is. A recording stands once for each run that judges it."""


def eligible_pairs(candidates: Candidates, rule: Rule) -> Int[np.ndarray, "p 2"]:
    """Every pair that `rule` allows, as places among the candidates.

    The second of a pair is the one with more of what differs: the more adversarial or the more
    natural one. Where nothing has to differ it is the recorded one.
    """
    first, second = np.triu_indices(len(candidates.run), k=1)
    allowed = candidates.human[first] != candidates.human[second]
    for same in (candidates.run, candidates.start):
        allowed &= same[first] == same[second]
    if rule.recorded_with_found:
        allowed &= candidates.recorded[first] != candidates.recorded[second]
    alike = _axis(candidates, rule.alike)
    allowed &= np.abs(alike[first] - alike[second]) < rule.alike_below
    more = candidates.recorded.astype(float)
    if rule.different is not None:
        more = _axis(candidates, rule.different)
        allowed &= np.abs(more[first] - more[second]) > rule.different_above
    pairs = np.stack([first, second], axis=1)[allowed]
    swapped = more[pairs[:, 0]] > more[pairs[:, 1]]
    return np.asarray(np.where(swapped[:, None], pairs[:, ::-1], pairs))


def strata(
    candidates: Candidates, pairs: Int[np.ndarray, "p 2"], rule: Rule
) -> Int[np.ndarray, " p"]:
    """What a draw is balanced over: runs, and for recorded episodes with found ones also people."""
    runs: Int[np.ndarray, " p"] = candidates.run[pairs[:, 0]]
    if not rule.recorded_with_found:
        return runs
    both = np.stack([runs, candidates.human[pairs[:, 1]]], axis=1)
    numbers: Int[np.ndarray, " p"] = np.unique(both, axis=0, return_inverse=True)[1].reshape(-1)
    return numbers


def draw_pairs(
    episodes: Int[np.ndarray, "p 2"],
    strata: Int[np.ndarray, " p"],
    count: int,
    *,
    seed: int,
    reuse: bool = False,
) -> Int[np.ndarray, " k"]:
    """Draws pairs at random, in turn from each stratum, as long as it has any.

    Where that ends before `count`, it is tried again, `TRIES` times, and the largest draw counts.

    Args:
        episodes: Which episodes each pair shows.
        strata: Which stratum each pair belongs to.
        count: How many to draw.
        seed: Equal seeds draw equal pairs.
        reuse: Whether an episode may be in several pairs; else it is in one at most.

    Returns:
        Places of the pairs, in the order in which they were drawn; fewer than `count` where no
        more were found.

    Example:
        >>> draw_pairs(np.array([[0, 1], [2, 3]]), np.array([0, 1]), 5, seed=0).size
        2
    """
    rng = np.random.default_rng(seed)
    best: list[int] = []
    for _ in range(TRIES):
        found = _deal(episodes, _queues(strata, rng), count, reuse=reuse)
        best = max(best, found, key=len)
        if len(best) == min(count, len(episodes)) or reuse:
            break
    return np.array(best, dtype=int)


def reference_of(
    returns: Float[np.ndarray, " n"],
    starts: Int[np.ndarray, " n"],
    seeds: Int[np.ndarray, " n"],
    *,
    start: int,
    shown: Sequence[int],
) -> int:
    """The canonical episode that a pair is held against: the typical one of its start.

    Its return is nearest to the median of that start, the earliest of equals, so that most pairs of
    a run share theirs. It does not begin from the seed of an episode that is shown: the robot would
    begin in the same pose there and make the two look alike. Where that leaves none, the latter is
    dropped first, and then the start. Ours; the paper does not say which one it shows.

    Args:
        returns: Of the canonical episodes.
        starts: What the human starts from.
        seeds: Of their starts.
        start: That of the pair.
        shown: Seeds of the episodes of the pair.

    Raises:
        ValueError: There are no canonical episodes.

    Example:
        >>> three = np.array([5.0, 1.0, 9.0])
        >>> reference_of(three, np.zeros(3, int), np.array([4, 5, 6]), start=0, shown=[7, 8])
        0
    """
    if not len(returns):
        raise ValueError("there are no canonical episodes to be a reference")
    same = starts == start
    others = same & ~np.isin(seeds, shown)
    everyone = np.ones(len(returns), dtype=bool)
    places = next(np.flatnonzero(which) for which in (others, same, everyone) if which.any())
    typical = np.median(returns[same if same.any() else everyone])
    return int(places[np.argmin(np.abs(returns[places] - typical))])


def _axis(candidates: Candidates, axis: Axis) -> Float[np.ndarray, " n"]:
    return candidates.naturalness if axis == "naturalness" else candidates.adversarialness


def _queues(strata: Int[np.ndarray, " p"], rng: np.random.Generator) -> list[list[int]]:
    """The pairs of each stratum in random order; the strata too, so that none is always first."""
    order = rng.permutation(len(strata))
    names = rng.permutation(np.unique(strata))
    return [order[strata[order] == name][::-1].tolist() for name in names]


def _deal(
    episodes: Int[np.ndarray, "p 2"], queues: list[list[int]], count: int, *, reuse: bool
) -> list[int]:
    """Takes pairs from the end of each queue in turn, past those with an episode that is shown."""
    dealt: list[int] = []
    shown: set[int] = set()
    members = episodes.tolist()
    waiting = len(queues)
    for queue in cycle(queues):
        if waiting == 0 or len(dealt) == count:
            break
        while queue:
            pair = queue.pop()
            if reuse or not shown.intersection(members[pair]):
                dealt.append(pair)
                shown.update(members[pair])
                waiting = len(queues)
                break
        else:
            waiting -= 1  # Since the last pair that was dealt, as many queues were found empty.
    return dealt

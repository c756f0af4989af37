"""What the worst of canonical behaviour, played again, would reach: a ceiling for the six events.

At class weight κ a human who replays the worst ν/κ of canonical episodes still has naturalness ν,
if whole episodes are judged (docs/referee.md). Here the replays are judged by the headline referee,
as every human of a search is.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.planted.arena import (
    SCORING,
    TRAIN,
    VALIDATION,
    Arena,
    Judgement,
    chosen,
    judge_episodes,
    play_with,
)
from rigid.frontier.curve import area_under_frontier
from rigid.policies.gaussian import GaussianPolicy

SHARES = (0.05, 0.075, 0.1, 0.125, 0.15, 0.175, 0.2, 0.225, 0.25)
"""Shares of canonical episodes, the worst by return; 0.25 is 1/κ. Ours."""


def replays(arena: Arena) -> list[Judgement]:
    """The worst shares of canonical episodes, judged like humans."""
    needed = TRAIN + VALIDATION + SCORING
    human = GaussianPolicy(arena.opponent.human)
    drawn = play_with(
        arena.task, arena.robot, human, round(needed / SHARES[0]), np.random.default_rng(6)
    )
    order = np.argsort(drawn.returns)
    found = []
    for share in SHARES:
        worst = order[: round(share * len(order))]
        picked = np.random.default_rng(7).permutation(worst)[:needed]
        found.append(judge_episodes(arena, chosen(drawn, picked), 0))
    return found


def area(points: Sequence[Judgement], anchor: float) -> float:
    """Hull area of these points, canonical play, and plain sabotage, which everybody has."""
    pairs = [(point.naturalness, point.adversarialness) for point in points]
    return area_under_frontier([*pairs, (0.0, 1.0)], anchor)

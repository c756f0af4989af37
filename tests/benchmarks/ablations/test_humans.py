"""Episodes of several humans, by use."""

from __future__ import annotations

import numpy as np

from benchmarks.ablations.humans import parts_of
from rigid.learning.rollout import Trajectories
from rigid.tasks.protocol import Summary

STEPS, COUNTS = 3, (3, 2, 1)


def numbered_episodes(count):
    """The feature and the return of an episode say which one it is; the second one faults."""
    number = np.tile(np.arange(float(count)), (STEPS, 1))
    weight = np.ones((STEPS, count))
    weight[1:, 1] = 0
    blank = np.zeros((STEPS, count, 1))
    ends = {name: np.zeros(count) for name in ("success", "peak_force", "impulse")}
    return Trajectories(
        blank, blank, blank, blank, number / STEPS, number[..., None], weight,
        Summary(outcome=np.zeros(count, int), extra={}, **ends),
    )  # fmt: skip


def test_each_human_has_a_block_that_is_divided_in_order():
    played = numbered_episodes(12)
    for human in (0, 1):
        parts = parts_of(played, COUNTS, human)
        seen = [part.features[:, 0, 0].tolist() for part in parts[:3]]
        first = 6.0 * human
        assert seen == [[first, first + 1, first + 2], [first + 3, first + 4], [first + 5]]
        assert parts.ended.returns.tolist() == [first + 5]


def test_steps_after_a_fault_are_not_sound():
    parts = parts_of(numbered_episodes(6), COUNTS)
    assert parts.train.sound[1].tolist() == [True, False, False]
    assert parts.train.sound[0].all()

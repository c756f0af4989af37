"""Episodes from given starts: in turns they are the same episodes, in the same order."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.compute.playing import play_in_turns
from rigid.tasks.bridges.task import MOST_WORLDS
from rigid.tasks.views.watched import watched
from tests.compute.tiny import FilmedReach
from tests.toys import Follower

STARTS = np.arange(10, 17)
HUMANS = 3


class Heavy(FilmedReach):
    """Worlds of which there may be only a few; remembers how many there were."""

    def __init__(self, most_worlds):
        super().__init__()
        self.most_worlds, self.batches = most_worlds, []

    def make_world(self, batch, *, threads=0):
        self.batches.append(batch)
        return super().make_world(batch, threads=threads)


def still(worlds):
    """Humans who each push in a way of their own, whatever they see."""
    pushes = np.repeat(np.array([-1.0, 0.0, 1.0]), worlds // HUMANS)[:, np.newaxis]
    return lambda _: pushes


def played(task):
    seen = []
    return play_in_turns(task, Follower(), still, STARTS, humans=HUMANS, snapshots=seen), seen


@pytest.mark.parametrize("most_worlds", [1, 3, 6, 8, 9, 20, 21, 1000])
def test_turns_change_no_number_and_no_order(most_worlds):
    at_once, film = played(FilmedReach())
    in_turns, films = played(Heavy(most_worlds))
    for one, other in zip(at_once[:-1], in_turns[:-1], strict=True):
        np.testing.assert_array_equal(one, other)
    for one, other in zip(at_once.summary[:-1], in_turns.summary[:-1], strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(np.stack(film), np.stack(films))


@pytest.mark.parametrize("most_worlds", [3, 8, 20])
def test_no_turn_has_more_worlds_than_the_task_allows(most_worlds):
    task = Heavy(most_worlds)
    played(task)
    assert max(task.batches) <= most_worlds
    assert sum(task.batches) == HUMANS * len(STARTS)


def test_every_human_has_a_world_even_where_that_is_more_than_the_task_allows():
    task = Heavy(1)
    played(task)
    assert task.batches == [HUMANS] * len(STARTS)


def test_a_task_that_says_nothing_plays_all_at_once():
    task = Heavy(0)
    del task.most_worlds
    played(task)
    assert task.batches == [HUMANS * len(STARTS)]


def test_a_view_keeps_the_limit():
    assert watched(Heavy(MOST_WORLDS), print).most_worlds == MOST_WORLDS

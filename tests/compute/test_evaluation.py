"""Evaluating a pair: every episode counts once, faults apart."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.compute.evaluation import BLOCK, evaluate
from tests.compute.schema import Point
from tests.toys import Follower, Pointer, ToyReach


class Batches(ToyReach):
    """Remembers how its worlds were used."""

    def __init__(self, **options):
        super().__init__(**options)
        self.sizes, self.starts = [], []

    def make_world(self, batch, *, threads=0):
        world = super().make_world(batch, threads=threads)
        begin = world.reset
        self.sizes.append(batch)

        def reset(seeds):
            self.starts.append(tuple(seeds))
            return begin(seeds)

        world.reset = reset
        return world


def found(task=None, **options):
    settings = {"episodes": 20, "seed": 0, **options}
    return evaluate(task or ToyReach(), Follower(), Pointer(), **settings)


def test_what_is_measured_has_the_names_of_a_point():
    assert set(found()) - {"return_std"} <= {
        field.alias or name for name, field in Point.model_fields.items()
    }


def test_a_helpful_pair_succeeds():
    result = found()
    assert result["success"] == 1
    assert result["outcomes"] == {"helped": 1, "unhelped": 0}
    assert result["faults"] == 0
    assert 0 < result["adversarialness"] < 0.5


def test_episodes_are_played_in_blocks_with_starts_of_their_own():
    task = Batches(horizon=2)
    result = found(task, episodes=BLOCK + 50)
    assert result["episodes"] == BLOCK + 50
    assert task.sizes == [BLOCK]
    assert len(task.starts) == 2
    assert not set(task.starts[0]) & set(task.starts[1])


def test_fewer_episodes_than_a_block_take_no_more_worlds():
    task = Batches(horizon=2)
    assert found(task, episodes=7)["episodes"] == 7
    assert task.sizes == [7]


def test_the_same_seed_gives_the_same_numbers():
    assert found(episodes=150) == found(episodes=150)
    assert found(seed=1) != found(seed=2)


def test_episodes_that_ran_away_are_counted_and_left_out():
    with_faults = found(Batches(fault_every=2), episodes=150)
    task = Batches(fault_every=2)
    found(task, episodes=150)
    starts = np.concatenate(task.starts)[:150]
    assert with_faults["faults"] == np.count_nonzero(starts % 2 == 0)
    assert with_faults["episodes"] == 150
    assert with_faults["success"] == 1


def test_nothing_is_known_when_every_episode_ran_away():
    result = found(ToyReach(fault_every=1))
    assert result["faults"] == result["episodes"] == 20
    assert result["return"] is result["success"] is result["adversarialness"] is None
    assert result["outcomes"] == {"helped": None, "unhelped": None}


def test_a_task_without_a_range_has_no_adversarialness():
    result = found(ToyReach(return_range=None))
    assert result["adversarialness"] is None
    assert result["return"] < 0


@pytest.mark.parametrize(("name", "value"), [("episodes", 0), ("seed", -1)])
def test_impossible_counts_are_refused(name, value):
    with pytest.raises(ValueError, match=rf"{name} must be at least \d, got {value}"):
        found(**{name: value})

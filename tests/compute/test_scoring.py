"""Scoring: endings, the episodes that are shown, and what is stored of them."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.compute.endings import Ended, measure
from rigid.compute.scoring import _shown
from tests.compute.tiny import TINY, FilmedReach
from tests.toys import ToyReach

TASK = ToyReach(return_range=(-10.0, 0.0))


def ending(returns, *, faulted=None, success=None) -> Ended:
    nothing = np.zeros(len(returns), dtype=np.float32)
    return Ended(
        np.array(returns, dtype=np.float32),
        nothing if faulted is None else np.array(faulted, dtype=np.float32),
        nothing if success is None else np.array(success, dtype=np.float32),
        np.zeros(len(returns), dtype=np.int64),
        nothing + 3,
        nothing + 4,
    )


def test_only_sound_episodes_of_the_block_are_measured():
    episodes = ending([-99, -10, -5, -99], faulted=[0, 0, 0, 1])
    result = measure(episodes, slice(1, 4), TASK, TASK.return_range)
    assert (result["episodes"], result["faults"]) == (3, 1)
    assert result["return"] == pytest.approx(-7.5)
    assert result["adversarialness"] == pytest.approx(0.75)
    assert (result["peak_force"], result["impulse"]) == (3, 4)


def test_success_is_unknown_where_the_task_defines_none():
    result = measure(ending([-1, -1], success=[1, np.nan]), slice(None), TASK, TASK.return_range)
    assert result["success"] is None


def test_the_worst_and_the_median_episode_are_shown():
    assert _shown(ending([-2, -9, -1, -5, -3]), slice(None)).tolist() == [1, 4]


def test_episodes_that_ran_away_are_not_shown():
    episodes = ending([-2, -99, -1, -5, -3], faulted=[0, 1, 0, 0, 1])
    assert _shown(episodes, slice(None)).tolist() == [3, 0]


def test_something_is_shown_when_every_episode_ran_away():
    assert _shown(ending([-2, -9], faulted=[1, 1]), slice(None)).tolist() == [1, 0]


@pytest.fixture(scope="module")
def stored(small_run):
    """Arrays of every adversary, by point id."""
    found = {}
    for point in small_run.points:
        with np.load(small_run.directory / "adversaries" / point["id"] / "episodes.npz") as file:
            found[point["id"]] = {name: file[name] for name in file.files}
    return found


def test_stored_episodes_give_the_points_numbers(small_run, stored):
    low, high = FilmedReach().return_range
    for point in small_run.points:
        returns = stored[point["id"]]["returns"]
        heights = np.clip((high - returns) / (high - low), 0, 1)
        assert len(returns) == point["episodes"] == TINY.scoring_episodes
        assert point["adversarialness"] == pytest.approx(heights.mean(), abs=1e-6)
        assert point["success"] == stored[point["id"]]["success"].mean()


def test_two_episodes_are_filmed_beside_canonical_ones_from_the_same_start(stored):
    steps = FilmedReach().horizon + 1
    goal = 2
    for arrays in stored.values():
        assert arrays["snapshots"].shape == arrays["canonical_snapshots"].shape == (2, steps, 3)
        np.testing.assert_array_equal(
            arrays["snapshots"][..., goal], arrays["canonical_snapshots"][..., goal]
        )
        assert arrays["canonical_returns"].shape == arrays["canonical_outcome"].shape == (2,)


def test_adversaries_of_a_group_are_scored_from_the_same_starts_on_fresh_noise(stored):
    first, second = stored["s0-r1-l1"], stored["s0-r1-l2"]
    np.testing.assert_array_equal(first["seeds"], second["seeds"])
    assert (first["returns"] != second["returns"]).any()

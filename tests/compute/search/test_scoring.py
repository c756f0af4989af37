"""Scoring: endings, the episodes that are shown, and what is stored of them."""

from __future__ import annotations

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.compute.endings import Ended, measure
from rigid.compute.preparation import settings_for
from rigid.compute.search.scoring import Court, Judged, Ruler, _shown, score, seen_by_referee
from rigid.learning.adversary import start_adversary
from rigid.learning.group_play import Opponent
from rigid.learning.rollout import play, policy_actor
from rigid.naturalness.referee import RefereeSettings
from tests.compute.tiny import TINY, FilmedReach
from tests.toys import Follower, Pointer, ToyReach, untrained

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


def test_the_referee_is_told_which_steps_of_whose_episodes_are_sound():
    task, mine = ToyReach(fault_every=3), slice(2, 5)
    actors = policy_actor(Follower(), 6, None), policy_actor(Pointer(), 6, None)
    played = play(task, task.make_world(6), np.arange(6), *actors)
    seen = seen_by_referee(played, mine)
    np.testing.assert_array_equal(seen.sound, played.weight.T[mine] == 1)
    np.testing.assert_array_equal(seen.features, played.features.swapaxes(0, 1)[mine])
    assert seen.sound.all(axis=1).tolist() == [True, False, True]


def test_its_own_discriminator_calls_a_step_natural_where_it_is_sound_and_scores_below_0():
    """The score is the goal, +1 or -1; every third seed runs away after 4 of 10 steps."""
    task, preset = FilmedReach(fault_every=3), replace(TINY, scoring_episodes=20)
    canonical = np.random.default_rng(0).permuted(np.tile((-1.0, 1.0), (40, 1)), axis=1)
    canonical = np.repeat(canonical.astype(np.float32)[:, None], task.horizon, axis=1)
    human, settings = untrained(task.human).parameters, settings_for(preset)
    opponent = Opponent(Follower(), human, canonical, np.arange(40), 1.0)
    adversary = start_adversary(opponent, settings, 0.0, jax.random.key(0))
    goal = [{"w": jnp.array([[0.0], [1.0]]), "b": jnp.zeros(1)}]
    discriminator = adversary.measure.discriminator._replace(network=goal)
    adversary = adversary._replace(measure=adversary.measure._replace(discriminator=discriminator))
    court = Court(task, opponent, Ruler((), (-20.0, 0.0), RefereeSettings()), preset, settings)

    ((point, arrays),) = score(court, [adversary], [Judged({}, 0.5)], entropy=2)

    seeds = arrays["seeds"]
    low = np.array([np.random.default_rng(seed).choice([-1.0, 1.0]) for seed in seeds]) < 0
    steps = np.where(seeds % 3 == 0, 4, 10)
    share = steps[low].sum() / steps.sum()
    assert point["naturalness_own"] == pytest.approx(share)
    for wrong in (1 - share, low.mean()):  # Scores above 0, and steps after a fault as well.
        assert abs(wrong - share) > 0.02


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

"""Play stays physical, and depends on seeds and actions alone."""

import numpy as np
import pytest

from tests.tasks.playing import at_rest, deepest_overlap, drawn, seen_alike


def uniform(task, rng, batch):
    return drawn(task, rng, batch)


def full(task, rng, batch):
    return tuple(np.sign(action) for action in drawn(task, rng, batch))


@pytest.mark.parametrize(("draw", "held"), [(uniform, 1), (full, 20)])
def test_random_episodes_stay_physical(task, draw, held):
    world, rng = task.make_world(64, threads=2), np.random.default_rng(0)
    world.reset(np.arange(64))
    low, high = task.model.jnt_range.T
    deepest, beyond = 0.0, 0.0
    for number in range(task.horizon):
        if number % held == 0:
            actions = draw(task, rng, 64)
        step = world.step(*actions)
        deepest = max(deepest, deepest_overlap(world))
        angles = world._batch.bind("qpos")
        beyond = max(beyond, (angles - high).max(), (low - angles).max())
        assert np.isfinite(step.reward).all()
    assert not step.faulted.any()
    assert not world._batch.warning.any()
    assert deepest < 0.02  # [m]; of itch scratching 0.004 uniform, 0.013 full.
    assert beyond < 0.05  # [rad]; of itch scratching 0.002 uniform, 0.019 full.


def test_a_seed_plays_the_same_in_any_world_of_any_batch_on_any_number_of_threads(task):
    alone = seen_alike(task, task.make_world(1, threads=1), [7])
    among = seen_alike(task, task.make_world(5, threads=2), [1, 7, 3, 2, 7])
    np.testing.assert_array_equal(alone[:, 0], among[:, 1])
    np.testing.assert_array_equal(alone[:, 0], among[:, 4])


def test_a_used_world_starts_like_a_fresh_one(task):
    world = task.make_world(2, threads=1)
    first = seen_alike(task, world, [7, 8])
    np.testing.assert_array_equal(first, seen_alike(task, world, [7, 8]))


def test_nobody_is_helped_or_struck_when_both_do_nothing(task):
    world = task.make_world(8, threads=1)
    world.reset(np.arange(8))
    for _ in range(20):
        world.step(*at_rest(task, 8))
    ended = world.summary()
    assert {task.outcome_names[index] for index in ended.outcome} == {"unhelped"}
    np.testing.assert_array_equal(ended.peak_force, 0)


def test_actions_beyond_one_are_clipped(task):
    steps = []
    for factor in (1, 5):
        world, rng = task.make_world(4, threads=1), np.random.default_rng(0)
        world.reset(np.arange(4))
        steps.append(world.step(*(factor * action for action in full(task, rng, 4))))
    np.testing.assert_array_equal(steps[0].human_observation, steps[1].human_observation)
    np.testing.assert_array_equal(steps[0].reward, steps[1].reward)


def test_a_reset_takes_a_seed_for_every_world(task):
    with pytest.raises(ValueError, match="4 worlds need as many seeds, not 3"):
        task.make_world(4).reset(np.arange(3))

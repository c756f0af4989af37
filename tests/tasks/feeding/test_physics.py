"""What feeding adds to physics: heads that start turned, and food that stops with its world."""

import numpy as np

from rigid.tasks.bodies import head


def test_seeds_draw_different_starts_and_heads(task):
    world = task.make_world(32, threads=1)
    world.reset(np.arange(32))
    angles = world._batch.bind("qpos")
    places = [task.model.joint(name).qposadr[0] for name in head.HEAD_JOINTS]
    assert len(np.unique(angles, axis=0)) == 32
    np.testing.assert_array_equal(angles[:, places[0]], 0)
    assert (np.abs(angles[:, places[1:]]) <= np.deg2rad(30) + 1e-9).all()
    assert (np.ptp(angles[:, places[1:]], axis=0) > np.deg2rad(40)).all()


def test_the_food_of_a_world_that_ran_away_stays_as_it_is(task):
    world = task.make_world(2, threads=1)
    world.reset(np.arange(2))
    world._batch.bind("qvel")[1, 2] = np.nan
    turning = np.zeros((2, 7))
    turning[:, 6] = 1
    rows = [world.step(turning, np.zeros((2, 4))) for _ in range(40)]
    spilled = np.sum([step.info["spilled"] for step in rows], axis=0)
    assert spilled[0] > 0
    assert spilled[1] == 0

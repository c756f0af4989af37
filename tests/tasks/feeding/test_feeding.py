"""A robot that brings the spoon to the mouth helps; a person who turns away prevents it."""

import numpy as np

from rigid.tasks.feeding.food import Piece
from tests.tasks.feeding.conftest import SEEDS
from tests.tasks.feeding.feeder import Feeder
from tests.tasks.playing import check_sums, played


def total(rows, name):
    return np.sum([step.info[name] for step in rows[1:]], axis=0)


def test_a_scripted_robot_feeds_everybody_who_keeps_still(fed):
    world, rows, _ = fed
    ended = world.summary()
    np.testing.assert_array_equal(ended.success, 1)
    np.testing.assert_array_equal(ended.outcome, 0)
    np.testing.assert_array_equal(ended.extra["spilled"], 0)
    assert (total(rows, "distance") < 30).all()


def test_a_person_who_turns_away_is_not_fed(task):
    away = np.tile([0.0, 1.0, 0.0, 1.0], (len(SEEDS), 1))  # Nods and turns to the left.
    world, rows, _ = played(task, Feeder(task), lambda _: away, SEEDS)
    assert world.summary().success.mean() < 0.5
    assert (total(rows, "reward_food") < 160).any()


def test_eaten_food_pays_in_the_step_that_eats_it(fed):
    world, rows, _ = fed
    eaten = np.array([step.info["eaten"] for step in rows[1:]])
    paid = np.array([step.info["reward_food"] for step in rows[1:]])
    np.testing.assert_array_equal(paid, 20.0 * eaten)
    np.testing.assert_array_equal(eaten.sum(axis=0), world.summary().extra["eaten"])
    assert (eaten.sum(axis=0) >= 6).all()


def test_the_reward_is_the_sum_of_its_named_terms(fed):
    check_sums(fed[1][1:])


def test_success_takes_six_eaten_pieces(task):
    world = task.make_world(3, threads=1)
    world.reset(np.arange(3))
    for index, count in enumerate((5, 6, 8)):
        world.food[index, :count] = Piece.EATEN
    np.testing.assert_array_equal(world.summary().success, [0, 1, 1])
    names = [task.outcome_names[index] for index in world.summary().outcome]
    assert names == ["unhelped", "helped", "helped"]


def test_a_robot_that_turns_its_wrist_spills_everything_once(task):
    world = task.make_world(2, threads=1)
    world.reset(np.arange(2))
    turning = np.zeros((2, 7))
    turning[:, 6] = 1
    rows = [world.step(turning, np.zeros((2, 4))) for _ in range(60)]
    spilled = np.sum([step.info["spilled"] for step in rows], axis=0)
    np.testing.assert_array_equal(spilled, 8)
    np.testing.assert_array_equal(world.summary().extra["spilled"], 8)
    assert np.sum([step.info["reward_spill"] for step in rows]) == -5.0 * 16


def test_a_robot_that_keeps_still_spills_nothing(task):
    world = task.make_world(8, threads=1)
    world.reset(np.arange(8))
    for _ in range(20):
        world.step(np.zeros((8, 7)), np.zeros((8, 4)))
    np.testing.assert_array_equal(world.summary().extra["spilled"], 0)


def test_food_that_falls_over_the_lap_hits_the_person_and_over_the_table_does_not(task):
    over = np.array([[0.1, -0.2, 1.1], [0.0, -0.9, 1.1], [2.0, 2.0, 1.1]])
    heights, person = task.below(over)
    np.testing.assert_array_equal(person, [True, False, False])
    np.testing.assert_allclose(heights, [0.62, 0.725, 0.0], atol=0.05)

"""A robot that wipes along the arm helps; a person who takes the arm away prevents it."""

import numpy as np
import pytest

from tests.tasks.bed_bathing.bather import Bather
from tests.tasks.bed_bathing.conftest import SEEDS, still
from tests.tasks.playing import check_sums, played


def total(rows, name):
    return np.sum([step.info[name] for step in rows[1:]], axis=0)


def test_a_scripted_robot_bathes_whoever_keeps_still(bathed):
    world, rows, _ = bathed
    ended = world.summary()
    assert ended.success.mean() > 0.8
    assert (ended.outcome[ended.success == 1] == 0).all()
    assert (ended.extra["contact_steps"] > 10).all()
    assert np.mean(total(rows, "reward_wipe")) > 150
    assert not rows[-1].faulted.any()


def test_the_smaller_body_is_bathed_as_well(task):
    smaller = task.with_parameters(body="female")
    world, *_ = played(smaller, Bather(smaller), still, SEEDS)
    assert world.summary().success.mean() > 0.6


def test_a_person_who_lifts_the_arm_away_is_not_bathed(task):
    away = np.zeros((len(SEEDS), 10))
    away[:, 4] = -1.0  # The shoulder flexes: the arm goes up, and over the head.
    world, *_ = played(task, Bather(task), lambda _: away, SEEDS)
    assert world.summary().success.mean() < 0.4


def test_a_robot_that_keeps_still_wipes_nothing(task):
    world = task.make_world(8, threads=1)
    world.reset(np.arange(8))
    for _ in range(task.horizon):
        step = world.step(np.zeros((8, 7)), np.zeros((8, 10)))
    ended = world.summary()
    np.testing.assert_array_equal(ended.extra["wiped"], 0)
    np.testing.assert_array_equal(ended.success, 0)
    np.testing.assert_array_equal(ended.peak_force, 0)
    np.testing.assert_array_equal(step.info["reward_wipe"], 0)


def test_a_point_pays_once_in_the_step_that_wipes_it(bathed):
    world, rows, snapshots = bathed
    fresh = np.array([step.info["wiped"] for step in rows[1:]])
    paid = np.array([step.info["reward_wipe"] for step in rows[1:]])
    np.testing.assert_array_equal(paid, 5.0 * fresh)
    np.testing.assert_array_equal(fresh.sum(axis=0), world.summary().extra["wiped"])
    points = snapshots[..., -world.wiped.shape[1] :]
    assert (np.diff(points, axis=0) >= 0).all()  # What is wiped stays so.
    np.testing.assert_array_equal(np.diff(points.sum(axis=2), axis=0), fresh)


def test_the_reward_is_the_sum_of_its_named_terms(bathed):
    check_sums(bathed[1][1:])


def test_success_takes_thirty_percent_of_the_points(task):
    world = task.make_world(3, threads=1)
    world.reset(np.arange(3))
    for index, count in enumerate((38, 39, 129)):
        world.wiped[index, :count] = True
    ended = world.summary()
    np.testing.assert_array_equal(ended.success, [0, 1, 1])
    names = [task.outcome_names[index] for index in ended.outcome]
    assert names == ["unhelped", "helped", "helped"]


@pytest.mark.parametrize("index", [3, 4])
def test_a_new_episode_begins_unwiped(task, index):
    world = task.make_world(1, threads=1)
    world.reset(np.array([index]))
    world.wiped[:] = True
    world.reset(np.array([index]))
    assert not world.wiped.any()

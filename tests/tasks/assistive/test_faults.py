"""A world whose physics runs away restarts, counts as faulted, and disturbs no other world."""

import mujoco
import numpy as np
import pytest

from tests.tasks.playing import at_rest, drawn

RUNAWAYS = {"nan": np.nan, "infinite": np.inf, "fast": 60.0, "huge": 1e12}
every_runaway = pytest.mark.parametrize("value", RUNAWAYS.values(), ids=RUNAWAYS.keys())


def play(task, spoil=None, steps=12, batch=4):
    """Steps of an episode; `spoil(batch)` damages the state before step 5."""
    world, rng = task.make_world(batch, threads=2), np.random.default_rng(0)
    world.reset(np.arange(batch))
    rows = []
    for number in range(steps):
        if number == 5 and spoil:
            spoil(world._batch)
        rows.append(world.step(*drawn(task, rng, batch)))
    return world, rows


def spoiled(value, field="qvel"):
    def spoil(batch):
        batch.bind(field)[1, -5] = value  # A joint of the robot.

    return spoil


def test_a_runaway_world_leaves_no_log_file_behind(task, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    world, _ = play(task, spoiled(np.nan))
    assert world.faulted.any()
    assert not list(tmp_path.iterdir())


def test_the_reward_terms_of_a_faulted_world_are_nothing(task):
    _, rows = play(task, spoiled(np.nan))
    terms = [value for name, value in rows[-1].info.items() if name.startswith("reward_")]
    assert np.any([term[0] != 0 for term in terms])
    assert not np.any([term[1] for term in terms])


@every_runaway
def test_a_runaway_world_leaves_the_others_alone_bit_for_bit(task, value):
    _, healthy = play(task)
    _, rows = play(task, spoiled(value))
    others = [0, 2, 3]
    for one, other in zip(healthy, rows, strict=True):
        for field in ("reward", "human_observation", "features"):
            np.testing.assert_array_equal(
                getattr(one, field)[others], getattr(other, field)[others]
            )


@every_runaway
def test_a_fault_lasts_to_the_end_of_the_episode_and_earns_nothing(task, value):
    world, rows = play(task, spoiled(value))
    for number, step in enumerate(rows):
        np.testing.assert_array_equal(step.faulted, [False, number >= 5, False, False])
        assert (step.reward[1] == 0) == (number >= 5)
        assert np.isfinite(step.human_observation).all()
        assert np.isfinite(step.robot_observation).all()
    assert world.summary().success[1] == 0


def test_nobody_was_helped_in_an_episode_that_ran_away(case, task):
    world, _ = play(task, spoiled(np.nan))
    case.help_all(world)
    np.testing.assert_array_equal(world.summary().success, [1, 0, 1, 1])
    np.testing.assert_array_equal(world.summary().outcome == 0, [True, False, True, True])


def test_a_runaway_world_goes_back_to_its_start(task):
    world, _ = play(task, spoiled(np.nan), steps=6)
    np.testing.assert_array_equal(world._batch.bind("qpos")[1], world._start[1])
    np.testing.assert_array_equal(world._batch.bind("qvel")[1], 0)


def test_a_broken_angle_is_a_fault(task):
    _, rows = play(task, spoiled(np.nan, "qpos"))
    np.testing.assert_array_equal(rows[-1].faulted, [False, True, False, False])


def test_the_engine_does_not_reset_a_world_on_its_own(task):
    assert task.model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_AUTORESET


def test_a_reset_clears_faults(task):
    world, _ = play(task, spoiled(np.nan))
    assert not world.reset(np.arange(4)).faulted.any()


def test_forces_of_a_faulted_world_do_not_enter_its_summary(task):
    _, calm = play(task, steps=5)
    world, _ = play(task, spoiled(1e12))
    assert world.summary().peak_force[1] <= max(step.info["force_on_person"][1] for step in calm)


def test_an_action_that_is_not_finite_is_a_fault_of_its_world(task):
    world = task.make_world(2, threads=1)
    world.reset(np.arange(2))
    robot, person = at_rest(task, 2)
    robot[1, 3] = np.nan
    step = world.step(robot, person)
    assert np.isfinite(step.reward).all()
    np.testing.assert_array_equal(step.faulted, [False, True])

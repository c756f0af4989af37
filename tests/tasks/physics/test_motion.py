"""A world that keeps its motion tells every physics step, and plays as one that does not."""

import numpy as np
import pytest

from rigid.tasks.protocol import KeepsMotion
from rigid.tasks.registry import make_task

SEEDS = np.arange(3)


@pytest.fixture(scope="module", params=["itch-scratching", "feeding", "bed-bathing"])
def task(request):
    """Each task on MuJoCo."""
    return make_task(request.param)


def worlds(task):
    """One world that keeps its motion and one that does not, both at their start."""
    keeping, plain = (task.make_world(len(SEEDS), threads=1) for _ in range(2))
    keeping.keep_motion()
    return (keeping, keeping.reset(SEEDS)), (plain, plain.reset(SEEDS))


def actions(task, count):
    """Random actions of robot and human."""
    rng = np.random.default_rng(0)
    sizes = (task.robot.action_size, task.human.action_size)
    return [[rng.uniform(-1, 1, (len(SEEDS), size)) for size in sizes] for _ in range(count)]


def angles(world, task):
    """Joint angles, which a snapshot has first, in single precision."""
    return world.snapshot()[:, : task.model.nq]


def test_the_last_physics_step_is_where_the_joints_are(task):
    (world, _), _ = worlds(task)
    assert isinstance(world, KeepsMotion)
    for action in actions(task, 4):
        world.step(*action)
        assert world.motion().shape == (len(SEEDS), task.parameters.substeps, task.model.nq)
        np.testing.assert_array_equal(world.motion()[:, -1].astype(np.float32), angles(world, task))


def test_the_motion_is_that_of_physics_steps_taken_one_by_one(task):
    fine = task.with_parameters(substeps=1)
    (world, _), (single, _) = (worlds(one)[0] for one in (task, fine))
    robot, human = (np.zeros_like(action) for action in actions(task, 1)[0])
    robot[:, 0] = 1.0
    start = world.motion()[:, 0]
    world.step(robot, human)
    single.step(robot, human)
    np.testing.assert_array_equal(world.motion()[:, 0], single.motion()[:, 0])
    turned = np.diff(np.concatenate([start[:, None], world.motion()], axis=1), axis=1)
    assert (np.abs(turned).max(axis=2) > 0).all()


def test_after_a_reset_the_motion_is_the_start_alone(task):
    (world, _), _ = worlds(task)
    world.step(*actions(task, 1)[0])
    world.reset(SEEDS)
    assert world.motion().shape == (len(SEEDS), 1, task.model.nq)
    np.testing.assert_array_equal(world.motion()[:, 0].astype(np.float32), angles(world, task))


def test_keeping_the_motion_changes_nothing_bit_for_bit(task):
    (keeping, first), (plain, expected) = worlds(task)
    for action in actions(task, 6):
        for one, other in zip(first[:5], expected[:5], strict=True):
            np.testing.assert_array_equal(one, other)
        np.testing.assert_array_equal(keeping.snapshot(), plain.snapshot())
        first, expected = keeping.step(*action), plain.step(*action)


def test_motion_can_be_kept_from_the_middle_of_an_episode(task):
    _, (world, _) = worlds(task)
    one, other = actions(task, 2)
    world.step(*one)
    world.keep_motion()
    assert world.motion().shape[1] == 1
    world.step(*other)
    assert world.motion().shape[1] == task.parameters.substeps


def test_a_world_that_ran_away_was_at_its_start_all_along(task):
    (world, _), _ = worlds(task)
    start = world.motion()[1, 0]
    robot, human = actions(task, 1)[0]
    robot[1, 3] = np.nan
    assert world.step(robot, human).faulted[1]
    np.testing.assert_array_equal(world.motion()[1], np.tile(start, (task.parameters.substeps, 1)))


def test_motion_that_was_not_kept_is_refused(task):
    _, (world, _) = worlds(task)
    with pytest.raises(ValueError, match=r"this world keeps no motion: call keep_motion\(\) first"):
        world.motion()

"""Play stays physical, runaways are faults, and equal seeds play alike."""

from importlib import resources

import numpy as np
import pytest

from rigid.tasks.bodies import head, jaco
from rigid.tasks.feeding.food import Piece
from rigid.tasks.feeding.starts import STARTS
from rigid.tasks.physics.starts import COUNT


def random_actions(rng, batch):
    return rng.uniform(-1, 1, (batch, 7)), rng.uniform(-1, 1, (batch, 4))


def play(world, seeds, steps=15):
    """What both agents see in every world, with the same actions in all of them."""
    rng, seen = np.random.default_rng(0), []
    step = world.reset(np.array(seeds))
    for _ in range(steps):
        seen.append(np.concatenate([step.robot_observation, step.human_observation], axis=1))
        robot, person = random_actions(rng, 1)
        step = world.step(np.repeat(robot, world.batch, 0), np.repeat(person, world.batch, 0))
    return np.array(seen)


@pytest.mark.parametrize("held", [1, 20])
def test_random_episodes_stay_physical(task, held):
    world, rng = task.make_world(32, threads=2), np.random.default_rng(0)
    world.reset(np.arange(32))
    deepest, action = 0.0, np.zeros((32, 11))
    for number in range(task.horizon):
        if number % held == 0:
            action = rng.uniform(-1, 1, (32, 11)) if held == 1 else rng.choice([-1.0, 1], (32, 11))
        step = world.step(action[:, :7], action[:, 7:])
        deepest = max(deepest, world._scene.penetration(world._scene.records["sensordata"]).max())
        assert np.isfinite(step.reward).all()
    assert not step.faulted.any()
    assert deepest < 0.02


def test_a_seed_plays_the_same_in_any_world_of_any_batch_on_any_number_of_threads(task):
    alone = play(task.make_world(1, threads=1), [7])
    among = play(task.make_world(4, threads=2), [1, 7, 3, 7])
    np.testing.assert_array_equal(alone[:, 0], among[:, 1])
    np.testing.assert_array_equal(alone[:, 0], among[:, 3])


def test_seeds_draw_different_starts_and_heads(task):
    world = task.make_world(32, threads=1)
    world.reset(np.arange(32))
    angles = world._batch.bind("qpos")
    places = [task.model.joint(name).qposadr[0] for name in head.HEAD_JOINTS]
    assert len(np.unique(angles, axis=0)) == 32
    np.testing.assert_array_equal(angles[:, places[0]], 0)
    assert (np.abs(angles[:, places[1:]]) <= np.deg2rad(30) + 1e-9).all()
    assert (np.ptp(angles[:, places[1:]], axis=0) > np.deg2rad(40)).all()


def test_the_start_poses_are_many_clear_and_small_on_disk(task):
    assert STARTS.stored().shape == (COUNT, len(jaco.JOINT_NAMES))
    assert len(np.unique(STARTS.stored(), axis=0)) == COUNT
    assert len(task.starts) == COUNT
    file = resources.files("rigid.tasks.feeding") / "starts.npz"
    assert len(file.read_bytes()) < 50_000


def test_a_start_is_where_the_original_begins(task):
    arm = STARTS.kinematics(task.model)
    for angles in task.starts[::32]:
        place, turned = arm.pose(angles)
        assert (np.abs(place - STARTS.goal) < STARTS.spread + 0.01).all()
        assert (STARTS.rotation.inv() * turned).magnitude() < np.deg2rad(1)


@pytest.mark.slow
def test_starts_can_be_solved_again(task):
    arm = STARTS.kinematics(task.model)
    assert all(arm.clear(angles) for angles in STARTS.solve(task.build_spec(), 2, seed=1))


@pytest.mark.parametrize("value", [np.nan, 60.0, 1e12], ids=["nan", "fast", "huge"])
def test_a_runaway_world_is_a_fault_and_leaves_the_others_alone(task, value):
    def steps(spoil):
        world, rng = task.make_world(3, threads=1), np.random.default_rng(0)
        world.reset(np.arange(3))
        rows = []
        for number in range(8):
            if number == 5 and spoil:
                world._batch.bind("qvel")[1, 6] = value
            rows.append(world.step(*random_actions(rng, 3)))
        return world, rows

    (_, sound), (world, rows) = steps(False), steps(True)
    for number, (one, other) in enumerate(zip(sound, rows, strict=True)):
        np.testing.assert_array_equal(other.faulted, [False, number >= 5, False])
        np.testing.assert_array_equal(one.reward[[0, 2]], other.reward[[0, 2]])
        np.testing.assert_array_equal(one.features[[0, 2]], other.features[[0, 2]])
        assert (other.reward[1] == 0) == (number >= 5)
        assert np.isfinite(other.robot_observation).all()
    world.food[:] = Piece.EATEN
    np.testing.assert_array_equal(world.summary().success, [1, 0, 1])
    assert not world.reset(np.arange(3)).faulted.any()


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


def test_a_reset_takes_a_seed_for_every_world(task):
    with pytest.raises(ValueError, match="2 worlds need as many seeds, not 3"):
        task.make_world(2).reset(np.arange(3))


def test_actions_beyond_one_are_clipped(task):
    worlds = [task.make_world(2, threads=1) for _ in range(2)]
    signs = np.random.default_rng(0).choice([-1.0, 1.0], (2, 11))
    steps = []
    for world, factor in zip(worlds, (1, 5), strict=True):
        world.reset(np.arange(2))
        steps.append(world.step(factor * signs[:, :7], factor * signs[:, 7:]))
    np.testing.assert_array_equal(steps[0].human_observation, steps[1].human_observation)
    np.testing.assert_array_equal(steps[0].reward, steps[1].reward)

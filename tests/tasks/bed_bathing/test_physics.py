"""The arm rests, play stays physical, runaways are faults, and equal seeds play alike."""

from importlib import resources

import mujoco
import numpy as np
import pytest

from rigid.tasks.bed_bathing.starts import STARTS
from rigid.tasks.bodies import bed, human, jaco
from rigid.tasks.bodies.jaco import Servo
from rigid.tasks.physics.starts import COUNT


def random_actions(rng, batch):
    return rng.uniform(-1, 1, (batch, 7)), rng.uniform(-1, 1, (batch, 10))


def play(world, seeds, steps=15):
    """What both agents see in every world, with the same actions in all of them."""
    rng, seen = np.random.default_rng(0), []
    step = world.reset(np.array(seeds))
    for _ in range(steps):
        seen.append(np.concatenate([step.robot_observation, step.human_observation], axis=1))
        robot, person = random_actions(rng, 1)
        step = world.step(np.repeat(robot, world.batch, 0), np.repeat(person, world.batch, 0))
    return np.array(seen)


@pytest.mark.parametrize("parameters", [{}, {"body": "female"}, {"percentile": 95.0}])
def test_an_arm_at_rest_lies_on_the_bed_and_stays_there(task, parameters):
    task = task.with_parameters(**parameters)
    world = task.make_world(16, threads=1)
    before = world.reset(np.arange(16)).features
    data = mujoco.MjData(task.model)
    data.qpos[:] = world._batch.bind("qpos")[0]
    mujoco.mj_kinematics(task.model, data)
    hand = task.parameters.body_size.hand
    assert abs(data.geom("right_hand").xpos[2] - hand - bed.MATTRESS_TOP) < 0.02
    for _ in range(30):
        step = world.step(np.zeros((16, 7)), np.zeros((16, 10)))
    moved = np.abs(step.features - before)
    assert moved[:, :10].max() < np.deg2rad(2)
    assert moved[:, 10:].max() < 1e-3
    assert not step.faulted.any()


def test_an_arm_pressed_into_the_bed_stays_on_it(task):
    world = task.make_world(8, threads=1)
    world.reset(np.arange(8))
    down, deepest = np.zeros((8, 10)), 0.0
    down[:, 4] = 1.0  # The shoulder extends.
    for _ in range(40):
        world.step(np.zeros((8, 7)), down)
        deepest = max(deepest, world._scene.penetration(world._scene.records["sensordata"]).max())
    assert not world.faulted.any()
    assert deepest < 0.01


@pytest.mark.parametrize("held", [1, 20])
def test_random_episodes_stay_physical(task, held):
    world, rng = task.make_world(32, threads=2), np.random.default_rng(0)
    world.reset(np.arange(32))
    deepest, action = 0.0, np.zeros((32, 17))
    for number in range(task.horizon):
        if number % held == 0:
            action = rng.uniform(-1, 1, (32, 17)) if held == 1 else rng.choice([-1.0, 1], (32, 17))
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


def test_the_start_poses_are_many_clear_and_small_on_disk(task):
    assert STARTS.stored().shape == (COUNT, len(jaco.JOINT_NAMES))
    assert len(np.unique(STARTS.stored(), axis=0)) == COUNT
    assert len(task.starts) == COUNT
    file = resources.files("rigid.tasks.bed_bathing") / "starts.npz"
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


def test_servos_are_those_of_itch_scratching(task):
    for name in (*human.ARM_JOINTS, *jaco.JOINT_NAMES):
        servo = task.model.actuator(f"{name}_servo")
        assert servo.gainprm[0] / -servo.biasprm[2] == pytest.approx(Servo.RATE)
        np.testing.assert_array_equal(servo.forcerange, (-1, 1))


@pytest.mark.parametrize("value", [np.nan, 60.0], ids=["nan", "fast"])
def test_a_runaway_world_is_a_fault_wipes_nothing_and_leaves_the_others_alone(task, value):
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
        assert (other.reward[1] == 0) == (number >= 5)
        assert np.isfinite(other.robot_observation).all()
    world.wiped[:] = True
    np.testing.assert_array_equal(world.summary().success, [1, 0, 1])
    assert not world.reset(np.arange(3)).faulted.any()

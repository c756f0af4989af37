"""What each player sees, from where, and what the robot does not see."""

import mujoco
import numpy as np
import pytest

from rigid.tasks.bodies import human, jaco, scratcher, wheelchair
from rigid.tasks.itch_scratching.scene import LIMBS
from tests.tasks.scripted import Scratcher, still

AGENTS = ("robot", "human")
JOINTS = {"robot": jaco.JOINT_NAMES, "human": human.ARM_JOINTS}


@pytest.fixture(scope="module")
def twins(task):
    """The same starts, physics and actions in two tasks that itch in different places."""
    tasks = [task.with_parameters(itch_limbs=(limb,)) for limb in LIMBS]
    worlds = [twin.make_world(4, threads=1) for twin in tasks]
    rows = [[world.reset(np.arange(4)) for world in worlds]]
    robot = Scratcher(tasks[0], worlds[0])
    for _ in range(30):
        action = robot.act(worlds[0].itch)
        rows.append([world.step(action, np.zeros((4, 10))) for world in worlds])
    return rows


def test_the_robot_cannot_tell_where_it_itches(twins):
    for one, other in twins:
        np.testing.assert_array_equal(one.robot_observation, other.robot_observation)
    forces = [one.robot_observation[:, -1] for one, _ in twins]
    assert np.max(forces) > 0  # It has felt the limb.


def test_the_robot_cannot_tell_after_scratching_either_limb_to_the_end_of_the_episode(task):
    tasks = [task.with_parameters(itch_limbs=(limb,)) for limb in LIMBS]
    worlds = [twin.make_world(2, threads=1) for twin in tasks]
    one, other = (world.reset(np.arange(2)) for world in worlds)
    robot = Scratcher(task, worlds[0])
    for number in range(task.horizon):
        limb = number * len(LIMBS) // task.horizon
        action = robot.act(np.full(2, limb))
        one, other = (world.step(action, np.zeros((2, 10))) for world in worlds)
        np.testing.assert_array_equal(one.robot_observation, other.robot_observation)
    for world in worlds:  # Each has been helped a little, so that a counted contact cannot tell.
        assert world.counted.min() > 0


def test_the_person_feels_where_it_itches(twins):
    for one, other in twins[1:]:
        assert (one.human_observation != other.human_observation).any(axis=1).all()


def test_the_itch_shows_in_the_features_and_in_the_reward(twins):
    one, other = twins[-1]
    np.testing.assert_array_equal(one.features[:, :-2], other.features[:, :-2])
    np.testing.assert_array_equal(one.features[:, -2:], np.tile((1, 0), (4, 1)))
    np.testing.assert_array_equal(other.features[:, -2:], np.tile((0, 1), (4, 1)))
    assert (one.reward != other.reward).all()


@pytest.mark.parametrize("seeing", [False, True])
@pytest.mark.parametrize("agent", AGENTS)
def test_every_observed_number_has_a_name_and_bounds(task, agent, seeing):
    shown = task.seeing_the_itch() if seeing else task
    step = shown.make_world(1, threads=1).reset(np.array([0]))
    seen = step.robot_observation if agent == "robot" else step.human_observation
    spec = getattr(shown, agent)
    assert seen.shape == (1, spec.observation_size)
    assert len(spec.observation_names) == spec.observation_size
    assert shown.bounds(agent).shape == (spec.observation_size, 2)
    assert np.isfinite(shown.bounds(agent)).all()


def test_no_number_of_the_robot_is_named_after_the_itch(task):
    assert not [name for name in task.robot.observation_names if "itch" in name]
    assert [name for name in task.seeing_the_itch().robot.observation_names if "itch" in name]


@pytest.mark.parametrize("agent", AGENTS)
def test_observation_names_are_unique(task, agent):
    names = getattr(task, agent).observation_names
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("agent", AGENTS)
def test_ordinary_play_stays_within_the_bounds(task, agent):
    world, rng = task.make_world(32, threads=1), np.random.default_rng(0)
    world.reset(np.arange(32))
    low, high = task.bounds(agent).T.astype(np.float32)
    for number in range(60):
        if number % 20 == 0:
            robot, person = rng.choice([-1.0, 1.0], (32, 7)), rng.choice([-1.0, 1.0], (32, 10))
        step = world.step(robot, person)
        seen = step.robot_observation if agent == "robot" else step.human_observation
        outside = ((seen < low) | (seen > high)).any(axis=0)
        names = np.array(getattr(task, agent).observation_names)[outside]
        assert not names.size, names


@pytest.mark.parametrize("agent", AGENTS)
def test_an_action_turns_the_joint_that_is_seen_under_its_name(task, agent):
    names = JOINTS[agent]
    count, place = len(names), getattr(task, agent).observation_names.index(names[0])
    world = task.make_world(count, threads=1)
    world.reset(np.zeros(count, dtype=np.int64))
    push = np.eye(count)
    # Joint 6 may start at its upper limit; elbow and abduction have room both ways.
    push[:, -2] *= -1 if agent == "robot" else 1
    before, after = [
        world.step(*still(count)),
        *(
            world.step(*((push, still(count)[1]) if agent == "robot" else (still(count)[0], push)))
            for _ in range(4)
        ),
    ][::4]
    seen = [
        getattr(step, f"{agent}_observation")[:, place : place + count] for step in (before, after)
    ]
    turned = (seen[1] - seen[0]) * np.sign(push.sum(axis=1))[:, None]
    np.testing.assert_array_equal(np.abs(turned).argmax(axis=1), np.arange(count))
    assert (np.diag(turned) > 0.02).all()


@pytest.mark.parametrize("agent", AGENTS)
def test_observed_angles_are_those_of_the_named_joints(task, agent):
    world, rng = task.make_world(1, threads=1), np.random.default_rng(0)
    world.reset(np.array([0]))
    for _ in range(10):
        step = world.step(rng.uniform(-1, 1, (1, 7)), rng.uniform(-1, 1, (1, 10)))
    seen = getattr(step, f"{agent}_observation")[0]
    names = getattr(task, agent).observation_names
    for joint in JOINTS[agent]:
        address = task.model.joint(joint).qposadr[0]
        expected = np.float32(world._batch.bind("qpos")[0, address])
        assert seen[names.index(joint)] == expected, joint


def test_features_are_the_arm_and_nothing_of_the_robot(task):
    world, rng = task.make_world(1, threads=1), np.random.default_rng(0)
    world.reset(np.array([0]))
    step = world.step(rng.uniform(-1, 1, (1, 7)), rng.uniform(-1, 1, (1, 10)))
    addresses = [task.model.joint(name).qposadr[0] for name in human.ARM_JOINTS]
    angles, speeds = (world._batch.bind(name)[0, addresses] for name in ("qpos", "qvel"))
    np.testing.assert_array_equal(
        step.features[0, :20], np.concatenate([angles, speeds]).astype(np.float32)
    )
    assert len(task.feature_names) == step.features.shape[1] == 22


def replayed(task, steps=8):
    """The last control step again with mj_step: scene before its last physics step, Step, itch."""
    world, rng = task.make_world(1, threads=1), np.random.default_rng(3)
    world.reset(np.array([4]))
    for _ in range(steps):
        state = world._batch.state[0].copy()
        step = world.step(rng.uniform(-1, 1, (1, 7)), rng.uniform(-1, 1, (1, 10)))
    data = mujoco.MjData(task.model)
    mujoco.mj_setState(task.model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION.value)
    data.ctrl[:] = world._batch.bind("ctrl")[0]
    for _ in range(task.parameters.substeps):
        mujoco.mj_step(task.model, data)  # Leaves the kinematics of before its integration.
    np.testing.assert_array_equal(data.qpos, world._batch.bind("qpos")[0])
    return data, step, int(world.itch[0])


def test_poses_are_those_at_the_start_of_the_last_physics_step(task):
    data, step, itch = replayed(task)
    tip = data.site(scratcher.TIP_SITE).xpos.copy()
    spot = data.site(f"itch_{LIMBS[itch]}").xpos.copy()
    arm = [data.body(f"right_{link}").xpos for link in ("upper_arm", "forearm", "hand")]
    person = step.human_observation[0]
    np.testing.assert_allclose(person[:3], tip - task.chest, atol=1e-6)
    np.testing.assert_allclose(person[7:10], tip - spot, atol=1e-6)
    np.testing.assert_allclose(person[10:13], spot - task.chest, atol=1e-6)
    np.testing.assert_allclose(person[23:32].reshape(3, 3), arm - task.chest, atol=1e-6)
    mujoco.mj_kinematics(task.model, data)
    assert np.abs(data.site(scratcher.TIP_SITE).xpos - tip).max() > 1e-4  # It has moved on.


def test_the_robot_sees_from_its_base_which_faces_the_person(task):
    data, step, itch = replayed(task.seeing_the_itch())
    # The base is yawed by -90°: what it has ahead (x) lies at -y of the world.
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    tip, spot = data.site(scratcher.TIP_SITE).xpos, data.site(f"itch_{LIMBS[itch]}").xpos
    seen = step.robot_observation[0]
    np.testing.assert_allclose(seen[:3], turn @ (tip - wheelchair.JACO_MOUNT), atol=1e-6)
    np.testing.assert_allclose(seen[-6:-3], turn @ (tip - spot), atol=1e-6)
    np.testing.assert_allclose(seen[-3:], turn @ (spot - wheelchair.JACO_MOUNT), atol=1e-6)

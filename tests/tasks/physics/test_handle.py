"""What a player holds and sees of a task agrees with what its reports show."""

import numpy as np
import pytest

from rigid.tasks.by_hand import Handle, PlayedByHand
from rigid.tasks.registry import make_task

STEPS = 40


def played(name, parameters=None, steps=STEPS, *, wild=True):
    """A task, its handle, and an episode: states, and the poses as a player sees them."""
    task = make_task(name).with_parameters(**(parameters or {}))
    world, handle, rng = task.make_world(1, threads=1), task.make_handle(), np.random.default_rng(3)
    world.keep_motion()
    world.reset(np.array([1]))
    states = [world.snapshot()[0]]
    poses = [handle.poses(world.motion()[0], states[0])]
    for _ in range(steps):
        robot = rng.uniform(-1, 1, (1, 7)) if wild else np.zeros((1, 7))
        world.step(robot, rng.uniform(-1, 1, (1, task.human.action_size)))
        states.append(world.snapshot()[0])
        poses.append(handle.poses(world.motion()[0], states[-1]))
    return task, handle, np.array(states), poses


@pytest.fixture(scope="module", params=["itch-scratching", "feeding", "bed-bathing"])
def episode(request):
    return played(request.param)


def test_a_task_with_a_handle_is_playable(episode):
    task, handle, _, _ = episode
    assert isinstance(task, PlayedByHand)
    assert isinstance(handle, Handle)
    assert handle.substeps == task.parameters.substeps


def test_each_control_step_ends_with_the_poses_of_the_replay(episode):
    """Of spilled food as well, which the wild robot of feeding strews about."""
    task, handle, states, poses = episode
    replay = task.replay(states)
    assert list(handle.bodies) == replay["bodies"]
    for live, shown in zip(poses, replay["poses"], strict=True):
        np.testing.assert_allclose(live[-1], shown, atol=2e-5)


def test_a_control_step_shows_every_physics_step(episode):
    _, handle, _, poses = episode
    assert poses[0].shape == (1, len(handle.bodies), 7)
    assert {frame.shape[0] for frame in poses[1:]} == {handle.substeps}


def test_the_goal_is_that_of_the_replay(episode):
    task, handle, states, _ = episode
    assert handle.goal(states[3]) == task.replay(states[:2])["itch"]


def test_the_point_hardly_leaves_its_reach(episode):
    task, handle, states, _ = episode
    low, high = task.model.jnt_range.T
    state, rng = states[0].copy(), np.random.default_rng(0)
    centre, radius = handle.reach
    far = []
    for _ in range(300):
        state[: task.model.nq] = rng.uniform(low, high)
        far.append(np.linalg.norm(handle.place(state) - centre))
    # The shoulder itself gives way, by 10 cm.
    assert max(far) < radius + 0.12
    assert max(far) > 0.7 * radius


def test_the_hand_of_itch_scratching_is_where_the_scene_draws_it():
    task, handle, states, poses = played("itch-scratching", steps=3)
    point = next(k for k in task.scene()["keypoints"] if k["name"] == "hand")
    body = poses[-1][-1][handle.bodies.index(point["body"])]
    # The hand's centre lies its own radius from the wrist.
    assert np.linalg.norm(handle.place(states[-1]) - body[:3]) == pytest.approx(
        np.linalg.norm(point["pos"]), abs=1e-4
    )


def test_a_spread_itch_is_shown_where_it_is():
    task, handle, states, _ = played("itch-scratching", {"itch_spread": 0.8}, steps=1)
    assert handle.goal(states[0]) == task.replay(states)["itch"]
    fixed = make_task("itch-scratching").make_handle().goal(np.delete(states[0], -3))
    assert handle.goal(states[0])["pos"] != fixed["pos"]


def test_counted_is_what_the_task_has_counted_so_far():
    _, handle, states, _ = played("itch-scratching", steps=1)
    state = states[0].copy()
    state[-1] = 7
    assert handle.counted(state) == 7
    _, handle, states, _ = played("feeding", steps=1)
    state = states[0].copy()
    state[-8:] = [0, 1, 2, 1, 0, 0, 2, 1]
    assert handle.counted(state) == 3


def test_food_is_on_the_spoon_in_the_mouth_or_on_its_way_down():
    task, handle, states, _ = played("feeding", steps=0)
    names = task.scene()["bodies"]
    where = [handle.bodies.index(names.index(name)) for name in ("spoon_food_0", "spoon_food_1")]
    head = handle.bodies.index(names.index("head"))
    motion, state = np.tile(states[0][: task.model.nq], (5, 1)).astype(float), states[0].copy()
    held = handle.poses(motion, state)
    state[-8:-6] = [1, 2]
    after = handle.poses(motion, state)
    np.testing.assert_array_equal(after[:, where[0]], after[:, head])
    fallen = held[0, where[1], 2] - after[:, where[1], 2]
    np.testing.assert_allclose(fallen, 9.81 / 2 * (0.02 * np.arange(1, 6)) ** 2, atol=1e-9)

"""Random play stays physical: no runaways, no deep overlaps, joints within their limits."""

import numpy as np
import pytest


def uniform(rng, batch):
    return rng.uniform(-1, 1, (batch, 17))


def full(rng, batch):
    return rng.choice([-1.0, 1.0], (batch, 17))


@pytest.mark.parametrize(("draw", "held", "batch"), [(uniform, 1, 200), (full, 20, 64)])
def test_random_episodes_stay_physical(task, draw, held, batch):
    world, rng = task.make_world(batch, threads=2), np.random.default_rng(0)
    world.reset(np.arange(batch))
    low, high = task.model.jnt_range.T
    deepest, beyond = 0.0, 0.0
    for number in range(task.horizon):
        if number % held == 0:
            action = draw(rng, batch)
        step = world.step(action[:, :7], action[:, 7:])
        deepest = max(deepest, world._scene.penetration(world._scene.records["sensordata"]).max())
        angles = world._batch.bind("qpos")
        beyond = max(beyond, (angles - high).max(), (low - angles).max())
        assert np.isfinite(step.reward).all()
    assert not step.faulted.any()
    assert not world._batch.warning.any()
    assert deepest < 0.02  # [m]; seen: 0.004 uniform, 0.013 full.
    assert beyond < 0.05  # [rad]; seen: 0.002 uniform, 0.019 full.


def test_a_person_and_a_robot_that_do_nothing_stay_where_they_are(task):
    world = task.make_world(8, threads=1)
    first = world.reset(np.arange(8))
    for _ in range(task.horizon):
        last = world.step(np.zeros((8, 7)), np.zeros((8, 10)))
    np.testing.assert_allclose(last.features, first.features, atol=1e-9)


def test_actions_beyond_one_are_clipped(task):
    one, other = (task.make_world(4, threads=1) for _ in range(2))
    one.reset(np.arange(4))
    other.reset(np.arange(4))
    signs = np.random.default_rng(0).choice([-1.0, 1.0], (4, 17))
    once, more = (
        world.step(k * signs[:, :7], k * signs[:, 7:]) for world, k in ((one, 1), (other, 5))
    )
    np.testing.assert_array_equal(once.human_observation, more.human_observation)
    np.testing.assert_array_equal(once.reward, more.reward)


def test_success_takes_25_counted_contacts(task):
    world = task.make_world(3, threads=1)
    world.reset(np.arange(3))
    world.counted[:] = 24, 25, 26
    np.testing.assert_array_equal(world.summary().success, [0, 1, 1])
    names = [task.outcome_names[index] for index in world.summary().outcome]
    assert names == ["unhelped", "helped", "helped"]

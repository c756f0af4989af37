"""What itch scratching adds to physics: a person at rest, an arm rest, contacts that count."""

import numpy as np

from tests.tasks.playing import drawn


def test_a_person_and_a_robot_that_do_nothing_stay_where_they_are(task):
    world = task.make_world(8, threads=1)
    first = world.reset(np.arange(8))
    for _ in range(task.horizon):
        last = world.step(np.zeros((8, 7)), np.zeros((8, 10)))
    np.testing.assert_allclose(last.features, first.features, atol=1e-9)


def test_an_arm_deep_in_the_chair_is_a_fault_of_its_world(task):
    world, rng = task.make_world(4, threads=2), np.random.default_rng(0)
    world.reset(np.arange(4))
    world._batch.bind("qpos")[2, 3] = np.deg2rad(5)  # Arm down along the body: into the arm rest.
    world._batch.bind("qpos")[2, 6] = 0
    np.testing.assert_array_equal(
        world.step(*drawn(task, rng, 4)).faulted, [False, False, True, False]
    )


def test_success_takes_25_counted_contacts(task):
    world = task.make_world(3, threads=1)
    world.reset(np.arange(3))
    world.counted[:] = 24, 25, 26
    np.testing.assert_array_equal(world.summary().success, [0, 1, 1])
    names = [task.outcome_names[index] for index in world.summary().outcome]
    assert names == ["unhelped", "helped", "helped"]

"""What the report shows of an episode: the mouth as the goal, food that goes, forces, touches."""

import numpy as np
import pytest

from rigid.report.episodes import read_episode
from rigid.report.failure_rules import classify
from rigid.report.motion import read_motion
from rigid.tasks.feeding.food import Piece


@pytest.fixture(scope="module")
def shown(task, fed):
    """Scene and replay of an episode in which everything is eaten."""
    _, _, snapshots = fed
    return task.scene(), task.replay(snapshots[:, 0]), snapshots[:, 0]


def test_the_goal_rides_on_the_mouth(shown):
    scene, replay, _ = shown
    motion = read_motion(scene, replay)
    spoon = scene["bodies"].index("spoon")
    gap = np.linalg.norm(motion.path(motion.itch) - motion.poses[:, spoon, :3], axis=1)
    np.testing.assert_allclose(gap, replay["distance"], atol=1e-3)
    assert replay["itch"]["limb"] == "mouth"


def test_an_episode_tells_what_went_wrong_in_the_words_of_the_task(shown):
    scene, replay, _ = shown
    falling = np.clip(np.arange(replay["frames"]) - 10, 0, 3).tolist()
    spilled = {**replay, "outcome": "unhelped", "spilled": falling}
    failure = classify(read_episode(scene, spilled), None)
    assert (failure["kind"], failure["frame"]) == ("spilled", 13)
    assert failure["says"].endswith("cm from the mouth")


def test_food_rides_on_the_spoon_until_it_is_eaten_in_the_head(shown):
    scene, replay, snapshots = shown
    motion = read_motion(scene, replay)
    spoon, head = (scene["bodies"].index(name) for name in ("spoon", "head"))
    for index in range(8):
        piece = scene["bodies"].index(f"spoon_food_{index}")
        on_spoon = np.linalg.norm(motion.poses[:, piece, :3] - motion.poses[:, spoon, :3], axis=1)
        carried = snapshots[:, -8 + index] == Piece.HELD
        assert (on_spoon[carried] < 0.025).all()
        eaten = motion.poses[~carried][:, piece, :3]
        np.testing.assert_array_equal(eaten, motion.poses[~carried][:, head, :3])
    assert replay["eaten"][-1] == 8
    assert replay["success"]


def test_spilled_food_falls_and_stays(task):
    world = task.make_world(1, threads=1)
    world.reset(np.array([0]))
    rows, turning = [world.snapshot()[0]], np.zeros((1, 7))
    turning[:, 6] = 1
    for _ in range(60):
        world.step(turning, np.zeros((1, 4)))
        rows.append(world.snapshot()[0])
    scene, replay = task.scene(), task.replay(np.array(rows))
    motion = read_motion(scene, replay)
    heights = motion.poses[:, [scene["bodies"].index(f"spoon_food_{i}") for i in range(8)], 2]
    gone = np.array(replay["spilled"]) == 8
    assert gone[-1]
    np.testing.assert_allclose(heights[-1], heights[-2], atol=1e-6)
    assert (heights[-1] < 0.74).all()  # On the table, the lap or the floor.


def test_series_have_a_value_for_every_frame(shown):
    _, replay, snapshots = shown
    for name in ("force_unwanted", "force_itch", "distance", "eaten", "spilled", "poses"):
        assert len(replay[name]) == replay["frames"] == len(snapshots)


def test_contacts_tell_spoon_and_mouth_from_the_rest(task, fed):
    _, rows, snapshots = fed
    touched = int(np.argmax([step.info["force_mouth"] for step in rows[1:]]) % snapshots.shape[1])
    bodies, replay = task.scene()["bodies"], task.replay(snapshots[:, touched])
    found = {(mark[5], bodies[mark[6]], bodies[mark[7]]) for mark in replay["contacts"]}
    assert (0, "spoon", "head") in found
    assert all(kind == 0 for kind, robot, person in found if (robot, person) == ("spoon", "head"))


def test_every_shape_can_be_drawn(task):
    scene = task.scene()
    kinds = {"capsule", "sphere", "box", "cylinder", "ellipsoid"}
    assert {geom["type"] for geom in scene["geoms"]} <= kinds
    roles = {scene["bodies"][geom["body"]]: geom["role"] for geom in scene["geoms"]}
    assert roles["spoon"] == "tool"
    assert roles["head"] == "human"
    assert roles["table"] == roles["wheelchair"] == "chair"
    assert roles["jaco_link_3"] == "robot"

"""What the report shows of an episode: arm and points, what is wiped, forces, touches."""

import numpy as np
import pytest

from rigid.report.episodes import read_episode
from rigid.report.failure_rules import classify
from rigid.report.motion import read_motion, tip_of
from rigid.tasks.bodies import wiper
from rigid.tasks.physics.touches import AT_TARGET, UNWANTED


@pytest.fixture(scope="module")
def shown(task, bathed):
    """Scene, replay and snapshots of an episode in which the arm is wiped."""
    world, _, snapshots = bathed
    best = int(np.argmax(world.summary().extra["wiped"]))
    return task.scene(), task.replay(snapshots[:, best]), snapshots[:, best]


def test_the_goal_rides_on_the_arm(shown):
    scene, replay, _ = shown
    motion = read_motion(scene, replay)
    elbow = scene["bodies"].index("right_forearm")
    np.testing.assert_allclose(motion.path(motion.itch), motion.poses[:, elbow, :3])
    assert replay["itch"]["limb"] == "right arm"
    assert scene["goal"] == "right arm"


def test_wiped_points_are_those_of_the_world(bathed, shown):
    world, *_ = bathed
    _, replay, snapshots = shown
    assert replay["wiped"][0] == 0
    assert replay["wiped"][-1] == world.summary().extra["wiped"].max()
    assert replay["success"]
    spoilt = snapshots.copy()
    spoilt[:, -world.wiped.shape[1] :] = 0
    assert not world._task.replay(spoilt)["success"]


def test_the_distance_is_that_of_pad_and_arm(bathed, shown):
    world, rows, _ = bathed
    _, replay, _ = shown
    best = int(np.argmax(world.summary().extra["wiped"]))
    seen = np.array([step.info["distance"][best] for step in rows[1:]])
    # A world's distance is one physics step older.
    np.testing.assert_allclose(replay["distance"][1:], seen, atol=0.02)
    assert min(replay["distance"]) == 0


def test_an_episode_tells_what_went_wrong_in_the_words_of_the_task(task):
    world = task.make_world(1, threads=1)
    world.reset(np.array([0]))
    rows = [world.snapshot()[0]]
    for _ in range(30):
        world.step(np.zeros((1, 7)), np.zeros((1, 10)))
        rows.append(world.snapshot()[0])
    replay = {**task.replay(np.array(rows)), "outcome": "unhelped"}
    failure = classify(read_episode(task.scene(), replay), None)
    assert "the right arm" in failure["says"]
    assert "itch" not in failure["says"]


def test_series_have_a_value_for_every_frame(shown):
    _, replay, snapshots = shown
    for name in ("force_unwanted", "force_itch", "distance", "wiped", "poses"):
        assert len(replay[name]) == replay["frames"] == len(snapshots)


def test_contacts_tell_pad_and_arm_from_the_rest(shown):
    scene, replay, _ = shown
    arm = {"right_upper_arm", "right_forearm", "right_hand"}
    bodies = scene["bodies"]
    found = {(mark[5], bodies[mark[6]], bodies[mark[7]]) for mark in replay["contacts"]}
    assert any(kind == AT_TARGET for kind, *_ in found)
    for kind, robot, person in found:
        assert kind == (AT_TARGET if robot == wiper.PAD_BODY and person in arm else UNWANTED)


def test_every_shape_can_be_drawn_and_points_are_not_taken_for_skin(task):
    scene = task.scene()
    kinds = {"capsule", "sphere", "box", "cylinder", "ellipsoid"}
    assert {geom["type"] for geom in scene["geoms"]} <= kinds
    roles = {scene["bodies"][geom["body"]]: geom["role"] for geom in scene["geoms"]}
    assert roles["wiper"] == roles["wiper_pad"] == "tool"
    assert roles["head"] == roles["right_forearm"] == "human"
    assert roles["bed"] == roles["cabinet"] == roles["points_forearm"] == "chair"
    assert roles["jaco_link_3"] == "robot"
    assert scene["bodies"][tip_of(scene).body] == wiper.PAD_BODY
    points = [geom for geom in scene["geoms"] if geom["name"].startswith("point_")]
    assert len(points) == len(task.points.limb)


def test_a_player_is_told_how_many_points_are_wiped(task, shown):
    _, replay, snapshots = shown
    assert [task.make_handle().counted(state) for state in snapshots[::25]] == replay["wiped"][::25]

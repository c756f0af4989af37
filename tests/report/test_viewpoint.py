"""The camera sees person, robot and what happens, and knows where they are in the picture."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.report.motion import read_motion, tip_of
from rigid.report.viewpoint import Viewpoint, centres, facing, viewpoint_for

AHEAD = Viewpoint(np.array([0.0, -2, 0]), np.zeros(3))
"""Looks along y; x is to the right."""


@pytest.fixture(scope="module")
def filmed(sample_payload):
    payload = sample_payload(seeds=1, replays=1)
    scene = payload["scene"]
    motions = [
        read_motion(scene, entry["worst"])
        for name, entry in payload["replays"].items()
        if "worst" in entry
    ]
    return scene, motions


def test_the_target_is_in_the_middle():
    np.testing.assert_allclose(AHEAD.project(np.zeros((1, 3)), 800, 600), [[400, 300]])


def test_right_is_right_and_up_is_up():
    (x, y), (far, _) = AHEAD.project(np.array([[0.1, 0, 0.1], [0.1, 1, 0]]), 800, 600)
    assert x > 400
    assert y < 300
    assert 400 < far < x  # What is farther looks smaller.


def test_the_edge_of_the_picture_is_half_the_field_of_view_away():
    edge = 2 * np.tan(np.deg2rad(16))
    np.testing.assert_allclose(
        AHEAD.project(np.array([[0, 0, edge]]), 800, 600), [[400, 0]], atol=1e-9
    )


def test_robot_tip_and_itch_are_in_the_picture(filmed):
    scene, motions = filmed
    for motion in motions:
        viewpoint = viewpoint_for(scene, motion)
        seen = np.concatenate([motion.path(tip_of(scene)), motion.path(motion.itch)])
        x, y = viewpoint.project(seen, 800, 600).T
        assert (x > 0).all()
        assert (x < 800).all()
        assert (y > 0).all()
        assert (y < 600).all()


def test_the_top_of_the_head_is_in_the_picture(filmed):
    scene, motions = filmed
    head = max(scene["geoms"], key=lambda geom: geom["role"] == "human" and geom["pos"][2])
    for motion in motions:
        human = centres(scene, motion, "human")
        top = human[human[:, 2].argmax()] + [0, 0, max(head["size"])]
        ((_, y),) = viewpoint_for(scene, motion).project(top[np.newaxis], 800, 600)
        assert y > 0


def test_room_is_left_above_the_head_for_a_title(filmed):
    scene, (motion, *_) = filmed
    human = centres(scene, motion, "human")
    top = human[human[:, 2].argmax()] + [0, 0, 0.16]
    ((_, y),) = viewpoint_for(scene, motion, free=0.3).project(top[np.newaxis], 800, 600)
    assert y >= 0.3 * 600 - 1e-6


def test_the_camera_stands_before_the_person_and_above(filmed):
    scene, (motion, *_) = filmed
    viewpoint = viewpoint_for(scene, motion)
    towards = viewpoint.position - viewpoint.target
    assert towards[1] < 0  # Whose legs point along -y.
    assert towards[2] > 0


def test_a_seated_person_faces_where_the_legs_are():
    trunk, knees = [[0, 0, 1.0], [0, 0, 1.4]], [[0, -0.4, 0.5], [0, -0.4, 0.3]]
    np.testing.assert_allclose(facing(np.array([*trunk, *knees])), [0, -0.4])


def test_of_one_geom_nobody_knows_where_it_faces():
    np.testing.assert_array_equal(facing(np.ones((1, 3))), [0, 0])

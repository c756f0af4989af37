"""The figure of keypoints: a row for each episode, red where contact should not be."""

from __future__ import annotations

import io

import numpy as np
import pytest
from matplotlib.colors import to_hex
from PIL import Image

from rigid.report.keypoints import (
    FORMATS,
    hull_points,
    keypoint_figure,
    keypoints_of,
    save_figure,
    views_of,
)
from rigid.report.motion import Shown

RED, GREY = "#d6330a", "#9aa0ab"


@pytest.fixture(scope="module")
def figure(struck):
    scene, shown = struck
    return keypoint_figure(scene, [shown, Shown("quiet", shown.canonical, None)])


def lines(axes, colour):
    return [line for line in axes.lines if to_hex(line.get_color()) == colour]


def test_a_row_for_each_episode_and_a_column_for_each_direction(figure):
    assert [row.get_suptitle() for row in figure.subfigs] == ["struck", "quiet"]
    for row in figure.subfigs:
        titles = [axes.get_title() for axes in row.axes]
        assert titles == ["from the front", "from the robot's side", "from above"]


def test_the_task_says_what_to_follow(struck):
    scene, shown = struck
    assert list(keypoints_of(scene, shown.motion)) == ["hand", "elbow", "tool tip"]


def test_without_a_word_from_the_task_moving_parts_and_the_tip_are_followed(sample_payload):
    from rigid.report.motion import read_motion

    payload = sample_payload(seeds=1, replays=1)
    scene = payload["scene"]
    motion = read_motion(scene, next(iter(payload["replays"]["canonical"].values())))
    assert list(keypoints_of(scene, motion)) == ["upper arm", "forearm", "hand", "tool tip"]


def test_trajectories_are_where_the_points_were(struck, figure):
    scene, shown = struck
    points = keypoints_of(scene, shown.motion)
    front = figure.subfigs[0].axes[0]
    for colour, anchor in zip(("#2f6db5", "#8a3fa0", "#1f7a74"), points.values(), strict=True):
        path = shown.motion.path(anchor)[:, [0, 2]]
        np.testing.assert_allclose(lines(front, colour)[0].get_xydata(), path)


def test_steps_with_undesired_contact_are_red_on_every_trajectory(struck, figure):
    hit = int((struck[1].motion.force_unwanted > 0).sum())
    assert hit > 0
    for axes in figure.subfigs[0].axes:
        dots = [line for line in lines(axes, RED) if line.get_marker() == "."]
        assert [len(line.get_xdata()) for line in dots] == [hit] * 3
        crosses = [line for line in lines(axes, RED) if line.get_marker() == "x"]
        assert len(crosses) == len(struck[1].motion.touches)


def test_an_episode_without_contact_has_no_red(figure):
    red = [line for axes in figure.subfigs[1].axes for line in lines(axes, RED)]
    assert sum(len(line.get_xdata()) for line in red) == 0


def test_canonical_motion_is_grey_where_it_is_known(figure):
    with_it, without = (row.axes[0] for row in figure.subfigs)
    assert len(lines(with_it, GREY)) == 3
    assert lines(without, GREY) == []


def test_from_the_front_the_persons_right_is_left_and_from_the_side_the_face_looks_away(struck):
    # The person faces -y; the right arm and the robot are at negative x.
    front, side, above = views_of(struck[0], struck[1].motion)
    assert (front.across, front.upwards, front.flipped) == (0, 2, (False, False))
    assert (side.across, side.upwards, side.flipped) == (1, 2, (True, False))
    assert (above.across, above.upwards, above.flipped) == (0, 1, (True, True))


@pytest.mark.parametrize(
    ("kind", "size", "half"),
    [
        ("sphere", (0.5,), (0.5, 0.5, 0.5)),
        ("capsule", (0.5, 1.0), (0.5, 0.5, 1.5)),
        ("cylinder", (0.5, 1.0), (0.5, 0.5, 1.0)),
        ("box", (0.5, 1.0, 2.0), (0.5, 1.0, 2.0)),
        ("ellipsoid", (0.5, 1.0, 2.0), (0.5, 1.0, 2.0)),
    ],
)
def test_a_silhouette_is_as_large_as_its_geom(kind, size, half):
    points = hull_points({"type": kind, "size": size})
    np.testing.assert_allclose(np.ptp(points, axis=0), 2 * np.array(half), rtol=1e-9)


@pytest.mark.parametrize(("suffix", "start"), [(".pdf", b"%PDF"), (".SVG", b"<?xml")])
def test_a_figure_is_saved_as_what_its_ending_says(figure, suffix, start):
    assert suffix.lower() in FORMATS
    assert save_figure(figure, suffix).startswith(start)


def test_a_png_is_large_enough_for_print(figure):
    assert Image.open(io.BytesIO(save_figure(figure, ".png"))).width >= 1800


@pytest.mark.parametrize("suffix", [".pdf", ".svg"])
def test_equal_episodes_give_equal_files(struck, suffix):
    scene, shown = struck
    files = {save_figure(keypoint_figure(scene, [shown]), suffix) for _ in range(2)}
    assert len(files) == 1

"""Frames of a real MuJoCo episode: the person turns red where the robot strikes, and only then."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.report import canvas
from rigid.report.film import TITLED, FilmSettings, Take, film, redness, shapes
from rigid.report.motion import Motion, Touch
from rigid.report.viewpoint import viewpoint_for

SMALL = FilmSettings(width=160, height=120, fps=10)


@pytest.fixture(scope="module")
def pictures(struck):
    scene, shown = struck
    takes = [Take(shown.motion, ""), Take(shown.canonical, "")]
    return [picture.astype(int) for picture in film(scene, takes, SMALL)]


def red(picture):
    """Pixels that are far more red than anything else of the scene is."""
    r, g, b = np.moveaxis(picture, -1, 0)
    return int(((r > 120) & (r > 2.5 * g) & (r > 2.5 * b)).sum())


def left(picture):
    return picture[:, : SMALL.width]


def right(picture):
    return picture[:, SMALL.width :]


def test_a_film_has_a_picture_a_frame_at_the_pace_of_the_recording(struck, pictures):
    assert len(pictures) == struck[1].motion.last + 1
    assert {picture.shape for picture in pictures} == {(120, 320, 3)}


def test_the_person_is_red_while_the_robot_strikes_and_not_before(struck, pictures):
    first = min(touch.frame for touch in struck[1].motion.touches)
    assert 1 < first <= struck[1].motion.last
    assert all(red(left(picture)) == 0 for picture in pictures[: first - 1])
    assert all(red(left(picture)) > 20 for picture in pictures[first:])


def test_nobody_is_red_in_the_other_take(pictures):
    assert [red(right(picture)) for picture in pictures] == [0] * len(pictures)


def test_both_takes_start_alike_and_part(pictures):
    np.testing.assert_array_equal(left(pictures[0]), right(pictures[0]))
    assert np.abs(left(pictures[-1]) - right(pictures[-1])).max() > 50


def test_the_part_that_is_struck_is_the_chest(struck):
    scene, shown = struck
    found = redness(shown.motion, shown.motion.last)
    assert {scene["geoms"][index]["role"] for index in found} == {"human"}
    assert {scene["geoms"][index]["name"]: value for index, value in found.items()}["chest"] == 1


def test_the_itch_is_where_the_viewpoint_says(struck):
    scene, shown = struck
    viewpoint = viewpoint_for(scene, shown.motion, free=TITLED)
    dot = shapes(scene, shown.motion, 0.0)[-1]
    dot = dot._replace(size=np.array([0.05, 0, 0]))
    with canvas.Canvas(320, 240) as drawing:
        picture = drawing.draw([dot], viewpoint).astype(int)
    yellow = np.argwhere(picture[..., 0] - picture[..., 2] > 60)
    (x, y), *_ = viewpoint.project(dot.position[None], 320, 240)
    np.testing.assert_allclose(yellow.mean(axis=0)[::-1], [x, y], atol=1.5)


def test_a_capsule_is_as_long_and_as_thick_as_it_says(struck):
    scene, shown = struck
    viewpoint = viewpoint_for(scene, shown.motion, free=TITLED)
    ends = viewpoint.target + np.outer([-0.3, 0.3], viewpoint.axes[0])
    turn = viewpoint.axes[[1, 2, 0]].T  # Its axis z lies across the picture.
    rod = canvas.Shape(
        "capsule", np.array([0.1, 0.2, 0]), viewpoint.target, turn, np.array([0, 0, 0, 1.0])
    )
    with canvas.Canvas(320, 240) as drawing:
        dark = np.argwhere(drawing.draw([rod], viewpoint).max(axis=-1) < 100)
    wide, high = np.ptp(dark, axis=0)[::-1] + 1
    across = np.ptp(viewpoint.project(ends, 320, 240)[:, 0])
    np.testing.assert_allclose([wide, high], [across, across / 3], atol=3)


@pytest.mark.parametrize(
    ("age", "strength"), [(-1.1, None), (-1, 1), (0, 1), (1, 1), (2, 0.5), (3, None)]
)
def test_a_touch_is_red_for_a_frame_around_it_and_fades_in_two(age, strength):
    touch = Touch(frame=5, at=np.zeros(3), geom=7)
    motion = Motion(np.zeros((10, 1, 7)), 0.1, None, (touch,), np.zeros(10))
    assert redness(motion, 5 + age).get(7) == strength


def test_of_two_touches_the_redder_counts():
    touches = tuple(Touch(frame, np.zeros(3), 7) for frame in (5, 7))
    motion = Motion(np.zeros((10, 1, 7)), 0.1, None, touches, np.zeros(10))
    assert redness(motion, 7.0) == {7: 1.0}


@pytest.mark.parametrize(("speed", "count"), [(1.0, 31), (0.5, 61), (2.0, 16)])
def test_a_film_lasts_as_long_as_the_episode_by_its_speed(speed, count):
    motion = Motion(np.zeros((11, 1, 7)), 0.1, None, (), np.zeros(11))
    times = FilmSettings(fps=30, speed=speed).times(motion)
    assert len(times) == count
    np.testing.assert_allclose(times[[0, -1]], [0, 10])


def test_a_machine_without_opengl_is_told_what_to_install(monkeypatch):
    monkeypatch.setattr(canvas, "_works", lambda _: False)
    canvas.backend.cache_clear()
    try:
        with pytest.raises(UserError, match="sudo apt-get install libegl1"):
            canvas.Canvas(8, 8)
    finally:
        canvas.backend.cache_clear()


@pytest.mark.parametrize(
    ("named", "tried"),
    [("", ["egl", "osmesa"]), ("osmesa", ["osmesa"]), ("glfw", ["egl", "osmesa"])],
)
def test_mujoco_gl_may_insist_on_one_of_the_two(monkeypatch, named, tried):
    asked = []
    monkeypatch.setenv("MUJOCO_GL", named)
    monkeypatch.setattr(canvas, "_works", asked.append)
    canvas.backend.cache_clear()
    try:
        assert canvas.backend() is None
    finally:
        canvas.backend.cache_clear()
    assert asked == tried

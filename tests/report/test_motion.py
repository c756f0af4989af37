"""Where bodies and shapes are between frames, and which part of the person was touched."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.report import encode_poses
from rigid.report.motion import Anchor, gap, half_lengths, placed, read_motion, tip_of

QUARTER = np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)])  # About z.
STILL = np.array([0, 0, 0, 1.0, 0, 0, 0])


def geom(body=1, kind="sphere", size=(0.1, 0, 0), pos=(0, 0, 0), role="human", name="part"):
    return {
        "name": name, "body": body, "type": kind, "size": list(size), "pos": list(pos),
        "quat": [1, 0, 0, 0], "rgba": [1, 1, 1, 1], "role": role,
    }  # fmt: skip


def scene_of(*geoms, **more):
    return {"bodies": ["world", "arm", "robot"], "geoms": list(geoms), **more}


def replay_of(*poses, **more):
    """Body 1 takes these poses, one a frame."""
    return {"bodies": [1], "frames": len(poses), "poses": np.array(poses)[:, None], **more}


def turned(position, quaternion):
    return np.concatenate([position, quaternion])


def test_halfway_between_frames_a_body_is_halfway_there_and_halfway_turned():
    motion = read_motion(scene_of(geom()), replay_of(STILL, turned([1, 0, 0], QUARTER)))
    eighth = [np.cos(np.pi / 8), 0, 0, np.sin(np.pi / 8)]
    np.testing.assert_allclose(motion.at(0.5)[1], [0.5, 0, 0, *eighth], atol=1e-12)


def test_a_body_turns_the_shorter_way():
    motion = read_motion(scene_of(geom()), replay_of(STILL, turned([0, 0, 0], -QUARTER)))
    eighth = [np.cos(np.pi / 8), 0, 0, np.sin(np.pi / 8)]
    np.testing.assert_allclose(motion.at(0.5)[1, 3:], eighth, atol=1e-12)


@pytest.mark.parametrize(("time", "x"), [(-1, 0), (0, 0), (1, 3), (2, 3)])
def test_frames_are_met_and_nothing_happens_beyond_them(time, x):
    motion = read_motion(scene_of(geom()), replay_of(STILL, turned([3, 0, 0], QUARTER)))
    assert motion.at(time)[1, 0] == x


def test_one_frame_is_an_episode():
    assert read_motion(scene_of(geom()), replay_of(STILL)).at(0).shape == (3, 7)


def test_poses_may_be_an_array_or_text():
    replay = replay_of(STILL, turned([0.5, 0.25, 0], QUARTER))
    packed = {**replay, "poses": encode_poses(replay["poses"])}
    scene = scene_of(geom())
    np.testing.assert_allclose(
        read_motion(scene, packed).poses, read_motion(scene, replay).poses, atol=1e-4
    )


def test_what_no_replay_moves_is_where_the_scene_puts_it_or_at_the_origin():
    rest = [STILL.tolist(), STILL.tolist(), [1, 2, 3, 1, 0, 0, 0]]
    resting = read_motion(scene_of(geom(), rest=rest), replay_of(STILL))
    np.testing.assert_array_equal(resting.poses[0, 2], rest[2])
    np.testing.assert_array_equal(
        read_motion(scene_of(geom()), replay_of(STILL)).poses[0, 2], STILL
    )


def test_a_point_rides_on_its_body():
    motion = read_motion(scene_of(geom()), replay_of(STILL, turned([0, 0, 2], QUARTER)))
    path = motion.path(Anchor(1, np.array([1.0, 0, 0])))
    np.testing.assert_allclose(path, [[1, 0, 0], [0, 1, 2]], atol=1e-12)


def test_a_geom_is_placed_by_its_body_and_its_own_frame():
    scene = scene_of({**geom(pos=(1, 0, 0)), "quat": QUARTER.tolist()})
    motion = read_motion(scene, replay_of(turned([0, 0, 2], QUARTER)))
    where = placed(scene, motion.at(0))
    np.testing.assert_allclose(where.positions[0], [0, 1, 2], atol=1e-12)
    np.testing.assert_allclose(where.turns[0], np.diag([-1, -1, 1]), atol=1e-12)


def test_the_part_touched_is_the_one_whose_surface_is_nearest():
    thick = geom(size=(0.4, 0, 0), name="thick")
    thin = geom(size=(0.1, 0, 0), pos=(1, 0, 0), name="thin")
    scene = scene_of(geom(role="robot", pos=(0.55, 0, 0)), thick, thin)
    mark = [0, 0.55, 0, 0, 3.0, 2]  # 0.15 m from the thick one, 0.35 m from the thin one.
    motion = read_motion(scene, replay_of(STILL, contacts=[mark]))
    assert motion.touches[0].geom == 1
    np.testing.assert_array_equal(motion.touches[0].at, [0.55, 0, 0])


def test_a_contact_that_names_the_body_is_believed():
    scene = scene_of(geom(body=1), geom(body=0, pos=(5, 0, 0)))
    motion = read_motion(scene, replay_of(STILL, contacts=[[0, 0.1, 0, 0, 3.0, 2, 2, 0]]))
    assert motion.touches[0].geom == 1


@pytest.mark.parametrize("kind", [0, 1])
def test_contacts_that_are_allowed_are_no_touches(kind):
    motion = read_motion(scene_of(geom()), replay_of(STILL, contacts=[[0, 0, 0, 0, 1.0, kind]]))
    assert motion.touches == ()


def test_without_a_person_nobody_is_touched():
    scene = scene_of(geom(role="robot"))
    motion = read_motion(scene, replay_of(STILL, contacts=[[0, 0, 0, 0, 1.0, 2]]))
    assert motion.touches[0].geom == -1


@pytest.mark.parametrize(
    ("kind", "size", "point", "distance"),
    [
        ("sphere", (0.5, 0, 0), (0, 0.75, 0), 0.25),
        ("capsule", (0.5, 1.0, 0), (1.0, 0, -0.5), 0.5),
        ("capsule", (0.5, 1.0, 0), (0, 0, 2.0), 0.5),
        ("cylinder", (0.5, 1.0, 0), (0, 0, -1.25), 0.25),
        ("cylinder", (0.5, 1.0, 0), (0.75, 0, 0.5), 0.25),
        ("box", (0.5, 1.0, 1.0), (0, 0, 0), -0.5),
        ("box", (0.5, 1.0, 1.0), (0, -1.5, 0), 0.5),
        ("ellipsoid", (0.25, 0.5, 0.75), (0, 0, 1.0), 0.5),
    ],
)
def test_distance_to_a_surface(kind, size, point, distance):
    assert gap(geom(kind=kind, size=size), np.array(point, float)) == distance


@pytest.mark.parametrize(
    ("kind", "size", "half"),
    [
        ("sphere", (0.5,), (0.5, 0.5, 0.5)),
        ("capsule", (0.5, 1.0), (0.5, 0.5, 1.5)),
        ("cylinder", (0.5, 1.0), (0.5, 0.5, 1.0)),
        ("box", (0.5, 1.0, 2.0), (0.5, 1.0, 2.0)),
    ],
)
def test_the_box_around_a_geom(kind, size, half):
    np.testing.assert_array_equal(half_lengths(geom(kind=kind, size=size)), half)


def test_the_tip_is_a_body_or_a_geom_or_unknown():
    assert tip_of({"bodies": ["world", "tool_tip"], "geoms": []}).body == 1
    named = tip_of(scene_of(geom(), geom(body=2, name="scratcher_tip", pos=(0, 0, 1))))
    assert named.body == 2
    np.testing.assert_array_equal(named.pos, [0, 0, 1])
    assert tip_of(scene_of(geom(name="tipped"))) is None


def test_a_replay_without_poses_is_refused():
    with pytest.raises(UserError, match="cannot be drawn: its replay has no bodies, only frames"):
        read_motion(scene_of(geom()), {"frames": 3, "hand": []})

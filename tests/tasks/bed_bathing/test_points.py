"""Points every 3 cm around upper arm and forearm; a touch wipes what is within 2.5 cm of it."""

import numpy as np
import pytest

from rigid.tasks.bed_bathing.points import (
    LIMBS,
    SPACING,
    WIPED_WITHIN,
    ArmPoints,
    arm_points,
    limb_points,
    wiped_now,
)
from rigid.tasks.bodies.sizes import BODIES

COUNTS = {"male": (81, 48, 39), "female": (56, 35, 28)}


def touches(*at, limb=0, world=0, step=2, worlds=2):
    """Contacts of the pad at places in a limb's frame, all at one physics step of five."""
    touching = np.zeros((worlds, 5, len(LIMBS), 2), dtype=bool)
    places = np.zeros((*touching.shape, 3))
    for index, place in enumerate(at):
        touching[world, step, limb, index] = True
        places[world, step, limb, index] = place
    return touching, places


@pytest.mark.parametrize("body", sorted(BODIES))
def test_each_body_has_as_many_points_as_in_the_original(body):
    points = arm_points(BODIES[body])
    upper, lower, enough = COUNTS[body]
    np.testing.assert_array_equal(np.bincount(points.limb), [upper, lower])
    assert points.enough == enough


def test_points_lie_on_the_skin_between_the_ends_of_the_limb():
    points = limb_points(0.04, 0.28)
    np.testing.assert_allclose(np.linalg.norm(points[:, :2], axis=1), 0.04)
    assert points[:, 2].max() < 0
    assert points[:, 2].min() > -0.28


def test_neighbours_on_a_ring_are_three_centimetres_of_skin_apart():
    ring = limb_points(0.043, 0.279)[:9]
    turns = np.unwrap(np.arctan2(-ring[:, 0], -ring[:, 1]))
    np.testing.assert_allclose(np.diff(turns) * 0.043, SPACING)
    np.testing.assert_allclose(ring[0, :2], (0, -0.043), atol=1e-12)  # The front of the arm.


@pytest.mark.parametrize(("gap", "wiped"), [(WIPED_WITHIN - 1e-4, 1), (WIPED_WITHIN + 1e-4, 0)])
def test_a_point_is_wiped_within_two_and_a_half_centimetres_of_a_touch(gap, wiped):
    points = ArmPoints(np.array([[0.0, -0.04, -0.1]]), np.array([0]))
    touching, places = touches((0.0, -0.04, -0.1 + gap))
    np.testing.assert_array_equal(wiped_now(points, touching, places), [[wiped], [0]])


def test_a_touch_at_any_physics_step_counts_for_its_own_world_and_limb_alone():
    points = arm_points(BODIES["male"])
    for limb in range(len(LIMBS)):
        mine = np.flatnonzero(points.limb == limb)
        place = points.places[mine[20]]
        found = wiped_now(points, *touches(place, limb=limb, world=1, step=4))
        assert not found[0].any()
        assert found[1, mine[20]]
        assert set(np.flatnonzero(found[1])) <= set(mine)


def test_both_contacts_of_a_pad_wipe():
    points = arm_points(BODIES["male"])
    one, other = points.places[0], points.places[45]
    apart = wiped_now(points, *touches(one)) | wiped_now(points, *touches(other))
    np.testing.assert_array_equal(wiped_now(points, *touches(one, other)), apart)
    assert apart[0, [0, 45]].all()


def test_no_touch_wipes_nothing():
    points = arm_points(BODIES["male"])
    touching, places = touches()
    assert not wiped_now(points, touching, places).any()

"""The pose that goes with a place of the hand is that of somebody who was watched."""

import numpy as np
import pytest

from rigid.tasks.itch_scratching.posture import stored_posture, watched_posture
from rigid.tasks.physics.posture import Posture, fit_posture

REST = np.array([0.5, -1.0])
RNG = np.random.default_rng(0)
WAYS = RNG.uniform(-0.3, 0.3, (400, 3))


def curved(ways):
    """Two joints that go along with a hand, straight and bent."""
    x, y, z = ways.T
    return REST + np.stack([2 * x - y + 3 * x * y, z - 4 * z * z], axis=-1)


@pytest.fixture(scope="module")
def posture():
    return fit_posture(WAYS, curved(WAYS), REST)


def test_it_is_the_watched_one(posture):
    for way in WAYS[:20]:
        np.testing.assert_allclose(posture.at(way), curved(way[None])[0], atol=0.01)


def test_a_hand_at_rest_has_the_pose_at_rest(posture):
    np.testing.assert_array_equal(posture.at(np.zeros(3)), REST)


def test_beyond_where_anybody_was_watched_the_pose_changes_no_more(posture):
    edge = posture.box[1]
    np.testing.assert_array_equal(posture.at(edge + 1.0), posture.at(edge))


def test_it_comes_back_from_its_file(posture, tmp_path):
    posture.save(tmp_path / "posture.npz")
    for one, other in zip(Posture.load(tmp_path / "posture.npz"), posture, strict=True):
        np.testing.assert_array_equal(one, other)


def test_the_stored_one_is_that_of_the_bundled_human():
    """Else `python -m rigid.tasks.itch_scratching.posture` was forgotten."""
    stored, watched = stored_posture(), watched_posture(4)
    ways = RNG.uniform(*(0.5 * stored.box), (50, 3))
    apart = [stored.at(way) - watched.at(way) for way in ways]
    assert np.rad2deg(np.sqrt(np.mean(np.square(apart)))) < 3.0

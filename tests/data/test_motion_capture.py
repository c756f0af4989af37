"""Motion capture of the bundled pair, at a camera's rate, becomes nearly the task's features."""

from __future__ import annotations

import json

import numpy as np
import pytest

from examples.motion_capture import MAP, record_people
from rigid.compute.playing import play_with
from rigid.learning.rollout import policy_actor
from rigid.policies.loading import load_policy
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.data.takes import brought_in

EPISODES = 2


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    path = tmp_path_factory.mktemp("camera") / "motion.csv"
    record_people(path, episodes=EPISODES, hz=25.0, seed=0)
    path.with_suffix(".json").write_text(json.dumps(MAP))
    return brought_in(path, task=ItchScratching(), map_=path.with_suffix(".json"))


@pytest.fixture(scope="module")
def played():
    """The very episodes, as the task shows them."""
    task = ItchScratching()
    robot = load_policy("builtin:vanilla", task=task, agent="robot")
    human = load_policy("builtin:synthetic-human", task=task, agent="human")
    rng = np.random.default_rng(0)
    starts = rng.integers(2**31, size=EPISODES)
    found = play_with(task, robot, policy_actor(human, EPISODES, rng), starts)
    return found.features.swapaxes(0, 1)


def test_angles_are_met_within_a_hundredth_of_a_radian(imported, played):
    angles = imported.episodes.features[..., :10]
    np.testing.assert_allclose(angles, played[..., :10], atol=0.01)


def test_the_itch_is_met_exactly(imported, played):
    np.testing.assert_array_equal(imported.episodes.features[..., 20:], played[..., 20:])


def test_velocities_are_the_motions_but_smoother(imported, played):
    found, true = imported.episodes.features[..., 10:20], played[..., 10:20]
    agree = [np.corrcoef(found[..., j].ravel(), true[..., j].ravel())[0, 1] for j in range(10)]
    assert min(agree) > 0.8
    assert imported.computed == tuple(ItchScratching.feature_names[:10])


def test_units_and_rate_are_told(imported):
    about = imported.episodes.about
    assert (about.units["elbow"], about.units["elbow_velocity"]) == ("rad", "rad/s")
    assert about.recorded_rate == 25.0
    assert about.participants == ("P01", "P02")

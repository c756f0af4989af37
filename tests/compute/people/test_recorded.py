"""Recordings: played again to the same end, and judged by the referees that a run stored."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigid.compute.people.recorded import (
    judge_recording,
    replay_recording,
    reproduced,
    stored_panels,
)
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.naturalness.strictest import strictest_naturalness
from rigid.naturalness.views import all_sound
from tests.compute.tiny import FilmedReach
from tests.toys import Follower, Pointer, ToyReach

HERE = Path("anna.npz")


class _Idle(Follower):
    def act(self, observation, state, rng):
        del rng
        return np.zeros((len(observation), 1)), state


def recorded(task, robot, episodes=5):
    return record(task, robot, Pointer(), episodes=episodes, seed=0, batch=10, provenance={})


def test_a_recording_played_again_has_the_same_states_and_returns():
    task = FilmedReach()
    recording = recorded(task, Follower())
    again = replay_recording(task, Follower(), recording, where=HERE)
    assert again.states.shape == (5, task.horizon + 1, 3)
    np.testing.assert_allclose(again.states[:, 1:, 1], recording.features[:, :, 0], atol=1e-6)
    np.testing.assert_allclose(again.returns, recording.returns, rtol=1e-5)
    assert reproduced(recording, again, task.return_range)


def test_with_another_robot_the_returns_are_others():
    task = FilmedReach()
    recording = recorded(task, Follower())
    again = replay_recording(task, _Idle(), recording, where=HERE)
    assert not reproduced(recording, again, task.return_range)
    unknown = replace(recording, returns=np.full(5, np.nan, np.float32))
    assert reproduced(unknown, again, task.return_range)


def test_an_episode_that_faults_when_it_is_played_again_is_not_the_same():
    task = FilmedReach()
    recording = recorded(task, Follower())
    runaway = FilmedReach(fault_every=1)
    again = replay_recording(runaway, Follower(), recording, where=HERE)
    assert not reproduced(recording, again, task.return_range)


def test_without_actions_nobody_can_see_it_again():
    recording = replace(recorded(FilmedReach(), Follower()), actions=None)
    with pytest.raises(UserError, match=r"anna\.npz holds no actions of the human"):
        replay_recording(FilmedReach(), Follower(), recording, where=HERE)


def test_where_seeds_are_only_numbers_of_episodes_nobody_can_see_it_again():
    recording = replace(recorded(FilmedReach(), Follower()), provenance={"seeds": "numbered"})
    with pytest.raises(UserError, match=r"anna\.npz has no column 'seed', so nobody knows how"):
        replay_recording(FilmedReach(), Follower(), recording, where=HERE)


@pytest.fixture(scope="module")
def panels(single_run):
    """The referees of `single_run`."""
    return stored_panels(single_run.directory, [point["id"] for point in single_run.points])


def judge(panels, recording, features="default"):
    return judge_recording(panels, features, ToyReach(), recording, where=HERE)


def test_people_are_judged_by_the_strictest_referee_of_the_run(panels):
    recording = recorded(ToyReach(), Follower(), 4)
    found = judge(panels, recording)
    assert found == strictest_naturalness(panels, all_sound(recording.features))


def test_referees_see_of_people_what_they_saw_of_adversaries(panels):
    """With other features, so that observations are missed where they are missing."""
    blind = replace(recorded(ToyReach(), Follower(), 4), observations=None)
    with pytest.raises(UserError, match=r"anna\.npz holds no observations and actions"):
        judge(panels, blind, "observation")


def test_a_point_that_is_no_id_leads_nowhere(single_run):
    with pytest.raises(UserError, match=r"has a point '\.\./x', which is no id such as s0-r1-l1"):
        stored_panels(single_run.directory, ["../x"])


def test_one_episode_cannot_be_judged():
    with pytest.raises(UserError, match=r"anna\.npz holds 1 episode.*record at least 2"):
        judge([], recorded(ToyReach(), Follower(), 1))

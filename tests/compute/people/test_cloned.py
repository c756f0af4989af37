"""A clone that moves like the recorded people may stand for them; another is told to be none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigid.compute.canonical import pick
from rigid.compute.people.clone_judging import held_out_naturalness, play_clone
from rigid.compute.people.cloned import clone_human
from rigid.data.about import About, EpisodeNote
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.learning.cloning import CloningSettings
from rigid.tasks.analytic.hand_tracking import NOISE, REACH, HandTracking
from tests.compute.tiny import hasten_referees

TASK = HandTracking()
ROBOT = TASK.builtin_policies("robot")["tracker"]
HUMAN = TASK.builtin_policies("human")["synthetic-human"]
FILE = Path("people.npz")
QUICK = CloningSettings(hidden=(), learning_rate=0.01, block=40, blocks=10, patience=3)


@pytest.fixture(scope="module", autouse=True)
def _quick_referees():
    """An eighth of the steps: these humans differ widely or not at all."""
    with pytest.MonkeyPatch.context() as patch:
        hasten_referees(patch, "rigid.compute.people.clone_judging", block=50, blocks=2)
        yield


@pytest.fixture(scope="module")
def people():
    found = record(TASK, ROBOT, HUMAN, episodes=60, seed=0, batch=60, provenance={})
    notes = tuple(EpisodeNote(participant=f"P{i % 6}") for i in range(60))
    return replace(found, source="recorded", about=About(licence="CC0-1.0", episodes=notes))


def cloned(people, **options):
    return clone_human(TASK, ROBOT, people, QUICK, seed=0, rollouts=120, where=FILE, **options)


@pytest.fixture(scope="module")
def clone(people):
    return cloned(people)


def test_a_clone_of_the_synthetic_human_has_its_noise_and_no_gain(clone):
    std = np.exp(np.asarray(clone.policy.parameters.log_std))
    assert std[0] == pytest.approx(NOISE / REACH, rel=0.08)
    errors = np.array([[-0.2], [0.0], [0.2]], np.float32)
    action, _ = clone.policy.act(errors, (), None)
    np.testing.assert_allclose(action, 0, atol=0.25 * NOISE / REACH)


def test_it_moves_as_naturally_and_returns_as_much(clone):
    assert clone.played["naturalness"] > 0.9
    assert clone.played["return"] == pytest.approx(clone.recorded["return"], rel=0.15)
    assert clone.recorded["success"] is None
    assert clone.parts.by == "participant"


def test_twelve_held_out_episodes_are_enough_to_hold_it_against_them_alone(people):
    played = play_clone(TASK, ROBOT, HUMAN, 60, 0)
    found = held_out_naturalness(TASK, pick(people, np.arange(12)), played, 0)
    assert found["episodes"] == 12
    assert found["naturalness"] > 0.8
    assert held_out_naturalness(TASK, pick(people, np.arange(11)), played, 0) is None


def test_with_few_held_out_people_it_is_told_that_its_naturalness_is_against_its_own(clone):
    assert len(clone.parts.test) == 10
    assert "the very people that it was cloned from" in clone.remarks[0]
    held_out = {"naturalness": 1.0, "naturalness_se": 0.0, "episodes": 12}
    richer = replace(clone, played={**clone.played, "held_out": held_out})
    assert not any("the very people" in remark for remark in richer.remarks)


def test_a_human_who_looks_at_nothing_is_no_worse_than_his_mean_action_and_is_told(clone):
    # Nothing can foresee noise: the clone ties with the mean, and a tie is no proof.
    gap = clone.likelihoods.clone - clone.likelihoods.mean_action
    assert abs(gap) < 0.02
    assert bool(clone.problems) == (gap <= 0)


def test_a_clone_of_people_in_another_world_is_told_to_be_unnatural(people):
    moved = replace(people, features=people.features + np.float32(1.0))  # As a wrong unit does.
    found = cloned(moved)
    assert found.played["naturalness"] < 0.2
    assert "a search would begin at behaviour that nobody showed" in found.problems[-1]


def test_without_observations_and_actions_nobody_is_cloned(people):
    with pytest.raises(UserError, match=r"people\.npz holds no observations and no actions of the"):
        cloned(replace(people, observations=None, actions=None))


def test_eleven_episodes_are_too_few_for_a_clone(people):
    with pytest.raises(UserError, match=r"holds 11 episodes, but a clone .* at least 12"):
        cloned(pick(people, np.arange(11)))

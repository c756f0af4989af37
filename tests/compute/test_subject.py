"""Who can be measured, and where canonical episodes are found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rigid.compute.subject import SYNTHETIC_HUMAN, Subject, canonical_path, load_players, stranger
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.policies.loading import policy_hash
from rigid.policies.native import save_policy
from tests.compute.tiny import FilmedReach
from tests.toys import untrained


@pytest.fixture
def subject(base):
    return Subject(FilmedReach(), *(str(base / "pair" / agent) for agent in ("robot", "human")))


def test_a_human_without_noise_cannot_be_searched_from(subject):
    with pytest.raises(UserError, match=r"'builtin:passive' has no action noise to search with"):
        load_players(replace(subject, human="builtin:passive"))


def test_a_human_with_memory_cannot_be_searched_from(subject, tmp_path):
    task = subject.task
    human = untrained(task.human, memory=3)
    save_policy(human, tmp_path / "h", agent="human", task=task.describe(), provenance={})
    with pytest.raises(UserError, match=r"sees its last 3 observations, but the search starts"):
        load_players(replace(subject, human=str(tmp_path / "h")))


def test_a_file_that_is_named_goes_before_the_one_beside_the_robot(subject, tmp_path):
    beside, named = tmp_path / "canonical.npz", tmp_path / "others.npz"
    beside.touch()
    subject = replace(subject, robot=str(tmp_path))
    assert canonical_path(subject) == beside
    assert canonical_path(replace(subject, canonical=str(named))) == named


def test_a_robot_without_episodes_beside_it_has_none(subject):
    assert canonical_path(subject) is None


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_no_recording_that_people_make_holds_the_episodes_of_the_referee(subject, seed):
    """Of several blocks of worlds: a block of one seed must not be one of another either."""
    task = FilmedReach()
    players = (untrained(task.robot), untrained(task.human))

    def starts(of):
        return record(task, *players, episodes=12, seed=of, batch=4, provenance={}).seeds

    rulers = [starts(replace(subject, canonical_draw=draw).ruler_seed) for draw in (0, seed)]
    assert set(starts(seed)).isdisjoint(np.concatenate(rulers))


@pytest.fixture
def stored(tmp_path):
    """Stores a robot that was trained for a human, and says what `stranger` says of it."""
    task = FilmedReach()
    human, other = untrained(task.human), untrained(task.human, seed=1)

    def say(made_by, *, called=SYNTHETIC_HUMAN):
        save_policy(
            untrained(task.robot), tmp_path / "r", agent="robot", task=task.describe(),
            provenance=made_by(policy_hash(human), policy_hash(other)),
        )  # fmt: skip
        return stranger(str(tmp_path / "r"), called, human, task)

    return say


def test_a_robot_that_meets_another_human_than_its_own_without_being_told_to_is_warned_of(stored):
    said = stored(lambda _, other: {"human": other})
    assert "was trained for another human than builtin:synthetic-human, who was taken" in said
    assert "name its own with --human" in said


@pytest.mark.parametrize(
    "made_by", [lambda own, _: {"human": own}, lambda *_: {}], ids=["its own", "nobody known"]
)
def test_a_robot_that_may_be_meeting_its_own_human_is_not_warned_of(stored, made_by):
    assert stored(made_by) is None


def test_who_names_a_human_means_that_one(stored):
    assert stored(lambda _, other: {"human": other}, called="runs/pair/human") is None


def test_what_is_no_native_policy_tells_no_human():
    task = FilmedReach()
    assert stranger("exec:./play", SYNTHETIC_HUMAN, untrained(task.human), task) is None

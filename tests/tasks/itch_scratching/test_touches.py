"""Contacts of a replay name who touches whom, also in hits that are over when a step ends."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.tasks.itch_scratching.scene import LIMBS
from rigid.tasks.itch_scratching.touches import contact_marks
from tests.report.struck import snapshots_of_a_strike
from tests.tasks.scripted import Scratcher

FRAME, FORCE, KIND, ROBOT, PERSON = 0, 4, 5, 6, 7


def named(task, replay):
    """Frame, kind and the names of both bodies, of every contact."""
    bodies = task.scene()["bodies"]
    marks = replay["contacts"]
    return [(m[FRAME], m[KIND], bodies[m[ROBOT]], bodies[m[PERSON]]) for m in marks]


@pytest.mark.parametrize("wrong", [0, 1], ids=["the itching limb", "the other limb"])
def test_contacts_name_the_scratcher_and_the_limb_that_it_scratches(task, wrong):
    world = task.make_world(1, threads=1)
    world.reset(np.array([0]))
    robot, snapshots = Scratcher(task, world), [world.snapshot()[0]]
    scratched = np.abs(wrong - world.itch)
    for _ in range(25):
        world.step(robot.act(scratched), np.zeros((1, 10)))
        snapshots.append(world.snapshot()[0])
    found = named(task, task.replay(np.array(snapshots)))
    assert found
    limb = f"right_{LIMBS[int(scratched[0])]}"
    assert {mark[1:] for mark in found} == {(wrong, "scratcher", limb)}


@pytest.fixture(scope="module")
def strike(task):
    """Snapshots of a robot that is away, and of one whose tip is in the person's chest."""
    rows = snapshots_of_a_strike(task)
    return rows[0], rows[-1]


def test_where_the_end_of_a_step_shows_the_contact_nothing_is_added(task, strike):
    snapshots = np.array(strike)
    expected = contact_marks(task.model, snapshots, np.array([False]), 5)
    assert [1, 2] in [[mark[FRAME], mark[KIND]] for mark in expected]
    assert contact_marks(task.model, snapshots, np.array([True]), 5) == expected


def test_a_hit_that_is_over_when_the_step_ends_is_marked(task, strike):
    away, hit = strike
    replay = task.replay(np.array([hit, away]))
    assert named(task, replay) == [(1, 2, "scratcher", "torso")]
    # The series adds up all that touches at once.
    assert 0 < replay["contacts"][0][FORCE] <= replay["force_unwanted"][1]


def test_where_nothing_touches_there_is_no_contact(task, strike):
    away, _ = strike
    assert task.replay(np.array([away, away]))["contacts"] == []

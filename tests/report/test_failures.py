"""Failures grouped into modes: who shows them, how natural they are, and how often."""

from __future__ import annotations

import pytest

from rigid.report.failure_kinds import words
from rigid.report.failures import group
from rigid.report.payload import FailureMode


def point(name, naturalness, helped, unhelped=0.0, unwanted=0.0):
    outcomes = {"helped": helped, "unhelped": unhelped, "unwanted_contact": unwanted}
    return {"id": name, "naturalness": naturalness, "outcomes": outcomes}


def failed(kind, part=None, frame=10):
    outcome = "unwanted_contact" if kind == "unwanted_contact" else "unhelped"
    failure = {"kind": kind, "part": part, "frame": frame, "time": frame / 10, "says": kind}
    return {"outcome": outcome, "failure": failure}


HELPED = {"outcome": "helped", "failure": None}
UNKNOWN = {"outcome": "unhelped", "failure": None}


def modes_of(points, replays):
    return {(mode["kind"], mode["part"]): mode for mode in group(points, replays, "itch")["modes"]}


def test_a_mode_lists_its_humans_from_the_most_natural_on_with_their_range():
    points = [point("a", 0.2, 0, 1), point("b", 0.9, 0.8, 0.2), point("c", 0.5, 0, 1)]
    replays = {
        "a": {"worst": failed("stuck"), "median": failed("thrashing")},
        "b": {"worst": failed("stuck", frame=40), "median": HELPED},
        "c": {"worst": failed("thrashing"), "median": failed("stuck")},
    }
    mode = modes_of(points, replays)["stuck", None]
    assert set(mode) == set(FailureMode.__annotations__)
    assert mode["points"] == ["b", "c", "a"]
    assert mode["naturalness"] == [0.2, 0.9]
    assert (mode["title"], mode["meaning"]) == words("stuck", "itch")
    assert mode["example"] == {
        "id": "b", "episode": "worst", "naturalness": 0.9,
        "frame": 40, "time": 4.0, "says": "stuck",
    }  # fmt: skip


def test_a_human_who_shows_a_mode_twice_counts_once_and_its_worst_episode_is_the_example():
    replays = {"a": {"worst": failed("stuck", frame=1), "median": failed("stuck", frame=2)}}
    mode = modes_of([point("a", 0.5, 0.4, 0.6)], replays)["stuck", None]
    assert mode["points"] == ["a"]
    assert (mode["example"]["episode"], mode["example"]["frame"]) == ("worst", 1)
    assert mode["share"] == pytest.approx(0.6)


def test_unwanted_contacts_are_told_apart_by_the_part_of_the_person():
    replays = {
        "a": {"worst": failed("unwanted_contact", "head"),
              "median": failed("unwanted_contact", "legs")},
    }  # fmt: skip
    found = group([point("a", 0.5, 0, 0, 1)], replays, "itch")["modes"]
    assert {mode["title"] for mode in found} == {"Unwanted contact: head", "Unwanted contact: legs"}


def test_an_outcome_is_split_over_the_episodes_that_ended_so_and_the_rest_is_unseen():
    points = [point("a", 0.5, 0.2, 0.3, 0.5), point("b", 0.6, 0.9, 0.1)]
    replays = {
        "a": {"worst": failed("unwanted_contact", "head"),
              "median": failed("unwanted_contact", "legs")},
        "b": {"worst": HELPED, "median": HELPED},
    }  # fmt: skip
    found = modes_of(points, replays)
    assert found["unwanted_contact", "head"]["share"] == pytest.approx(0.5 / 2 / 2)
    assert found["unwanted_contact", "legs"]["share"] == pytest.approx(0.5 / 2 / 2)
    assert group(points, replays, "itch")["unseen"] == pytest.approx((0.3 + 0.1) / 2)


def test_shares_of_modes_unseen_failures_and_help_add_up_to_one():
    points = [
        point("a", 0.5, 0.25, 0.25, 0.5),
        point("b", 0.6, 0.5, 0.5),
        point("c", 0.7, 0.5, 0.5),
    ]
    replays = {
        "a": {"worst": failed("unwanted_contact", "head"), "median": failed("stuck")},
        "b": {"worst": failed("stuck"), "median": failed("strayed")},
        "c": {"worst": UNKNOWN, "median": HELPED},
    }
    found = group(points, replays, "itch")
    total = sum(mode["share"] for mode in found["modes"]) + found["unseen"]
    assert total + (0.25 + 0.5 + 0.5) / 3 == pytest.approx(1)


def test_modes_of_the_most_natural_humans_come_first():
    points = [point("a", 0.1, 0, 1), point("b", 0.9, 0.99, 0.01)]
    replays = {
        "a": {"worst": failed("thrashing"), "median": failed("thrashing")},
        "b": {"worst": failed("lost_contact"), "median": HELPED},
    }
    kinds = [mode["kind"] for mode in group(points, replays, "itch")["modes"]]
    assert kinds == ["lost_contact", "thrashing"]


def test_where_nobody_failed_there_are_no_modes():
    found = group([point("a", 0.5, 1.0)], {"a": {"worst": HELPED, "median": HELPED}}, "itch")
    assert found == {"humans": 1, "modes": [], "unseen": 0.0}


def test_of_failures_that_no_stored_episode_shows_only_their_share_is_known():
    points, replays = [point("a", 0.5, 0.9, 0.1)], {"a": {"worst": HELPED, "median": HELPED}}
    assert group(points, replays, "itch") == {
        "humans": 1,
        "modes": [],
        "unseen": pytest.approx(0.1),
    }


def test_where_failures_tell_nothing_there_are_no_groups():
    assert (
        group([point("a", 0.5, 0, 1)], {"a": {"worst": UNKNOWN, "median": UNKNOWN}}, "itch") is None
    )
    assert group([point("a", 0.5, 0, 1)], None, "itch") is None


def test_a_human_whose_every_episode_ran_away_is_left_out():
    lost = {**point("b", 0.0, 0), "outcomes": {"helped": None, "unhelped": None}}
    replays = {"a": {"worst": failed("stuck")}, "b": {"worst": UNKNOWN}}
    assert group([point("a", 0.5, 0, 1), lost], replays, "itch")["humans"] == 1

"""Methods of several robots side by side."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rigid.errors import UserError
from rigid.frontier.standings import notes_of, standings_of, unlike_pairs
from rigid.frontier.successes import Played
from tests.frontier.samples import measured

VANILLA = [measured({0: 0.5, 1: 0.6}), measured({0: 0.4, 1: 0.5}, human="h1")]
ROBUST = [measured({0: 0.3, 1: 0.4}), measured({0: 0.2, 1: 0.3}, human="h1")]
BOTH = {"vanilla": VANILLA, "robust": ROBUST}


def test_numbers_are_means_over_robots_and_seeds_and_differences_pair_both():
    vanilla, robust = (standing.method for standing in standings_of(BOTH))
    assert vanilla.numbers["worst_at"].mean == pytest.approx(0.5)
    assert vanilla.against is None
    assert robust.against["worst_at"].mean == pytest.approx(-0.2)
    # Every robot and seed differs by the same, however much each of them varies.
    assert robust.against["worst_at"].interval == pytest.approx((-0.2, -0.2))
    low, high = robust.numbers["worst_at"].interval
    assert high - low > 0.1


def test_one_robot_each_is_compared_over_seeds_as_ever():
    from rigid.frontier.comparison import compare

    pair = {"a": VANILLA[:1], "b": [measured({0: 0.3, 1: 0.45, 2: 0.1})]}
    standing = standings_of(pair)[1].method
    rows = compare(
        {name: robots[0][0] for name, robots in pair.items()},
        {name: robots[0][1] for name, robots in pair.items()},
    )
    assert standing.against["auc"].mean == pytest.approx(rows[1].against["auc"].mean)
    assert standing.against["auc"].interval == pytest.approx(rows[1].against["auc"].interval)
    assert standing.numbers["auc"].interval == pytest.approx(rows[1].numbers["auc"].interval)


def test_robots_beyond_those_of_the_baseline_have_no_pair():
    alone = {"vanilla": VANILLA[:1], "robust": ROBUST}
    robust = standings_of(alone)[1].method
    assert robust.robots == 2
    assert robust.against["worst_at"].mean == pytest.approx(-0.2)
    assert robust.numbers["worst_at"].mean == pytest.approx(0.3)


def test_success_is_that_of_canonical_play():
    robots = [measured({0: 0.5}, success=share) for share in (1.0, 0.9)]
    assert standings_of({"vanilla": robots})[0].success.mean == pytest.approx(0.95)


def test_a_task_without_success_has_none():
    assert standings_of({"a": [measured({0: 0.5}, success=None)]})[0].success is None


def test_unseen_success_goes_to_the_method_of_the_robot():
    played = [Played(0, 0.5, 10), Played(1, 0.7, 10), Played(3, 0.9, 10)]
    vanilla, robust = standings_of(BOTH, played)
    assert vanilla.unseen.mean == pytest.approx(0.6)
    assert robust.unseen.mean == pytest.approx(0.9)


def test_nobody_asked_is_unknown():
    assert [standing.unseen for standing in standings_of(BOTH)] == [None, None]


def test_every_robot_has_to_be_measured_alike():
    """The second robot of the second method."""
    frontier, identity = measured({0: 0.3}, directory="runs/r-1")
    other = {**BOTH, "robust": [ROBUST[0], (frontier, {**identity, "preset": {"iterations": 9}})]}
    with pytest.raises(
        UserError,
        match=r"^vanilla \(run\) and robust \(runs/r-1\) cannot be compared: preset\.iterations",
    ):
        standings_of(other)


def test_paired_robots_of_different_humans_are_named():
    swapped = {"vanilla": VANILLA, "robust": ROBUST[::-1]}
    assert unlike_pairs(BOTH) == []
    assert unlike_pairs(swapped) == [
        f"robot {number} of robust was measured with another synthetic human than robot {number} "
        "of vanilla: the two pair by their order alone"
        for number in (1, 2)
    ]


def test_single_robots_of_different_humans_pair_by_seed_and_are_named():
    (said,) = unlike_pairs({"a": VANILLA[:1], "b": VANILLA[1:]})
    assert said.startswith("b was measured with another synthetic human than a: what is natural")


def test_notes_say_over_what_intervals_are_and_what_a_repeat_would_do():
    assert notes_of(standings_of(BOTH))[0].startswith("95 % intervals over robots and search seeds")
    alone = notes_of(standings_of({"a": VANILLA[:1], "b": ROBUST[:1]}))
    assert alone[0].startswith("to judge by its seeds alone, a repeat of a should lie within 0.")
    assert not any("over robots" in note for note in alone)


def test_a_note_names_each_method_for_which_canonical_play_stands():
    def at(naturalness, **changes):
        frontier, identity = measured({0: 0.5, 1: 0.6}, **changes)
        points = [{**point, "naturalness": naturalness} for point in frontier.points]
        return replace(frontier, data={**frontier.data, "points": points}), identity

    notes = notes_of(standings_of({"a": VANILLA, "b": [at(0.9), at(0.8, human="h1")]}))
    assert notes[0] == (
        "b: 2 of 4 searches found a human at naturalness ≥ 0.9; in the others canonical play "
        "stands there"
    )
    assert not any(note.startswith("a: ") for note in notes)


@pytest.mark.parametrize(("naturalness", "equal"), [(0.8, True), (0.85, False), (0.9, False)])
def test_a_note_says_why_the_hull_equals_the_area(naturalness, equal):
    """Canonical play and a human at 0.8 or below span a straight line over [0.8, 1]."""
    frontier, identity = measured({0: 0.5, 1: 0.6})
    points = [{**point, "naturalness": naturalness} for point in frontier.points]
    run = replace(frontier, data={**frontier.data, "points": points}), identity
    standings = standings_of({"a": [run]})
    hull, area = (standings[0].method.numbers[key].mean for key in ("hull_at", "auc_natural"))
    assert hull >= area
    assert (hull == pytest.approx(area)) is equal
    said = [note for note in notes_of(standings) if "hull at 0.9 equals mean over [0.8, 1]" in note]
    assert bool(said) is equal

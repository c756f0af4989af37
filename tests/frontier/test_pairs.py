"""Which episodes make a pair, and which pairs are drawn: rules by hand, and for any episodes."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid.frontier.pairs import (
    RULES,
    Candidates,
    draw_pairs,
    eligible_pairs,
    reference_of,
    strata,
)


def candidates(points, **columns):
    """Episodes at (naturalness, adversarialness), each of a human of its own in one run."""
    count = len(points)
    same = np.zeros(count, dtype=int)
    given = {
        "run": same, "human": np.arange(count), "start": same, "episode": np.arange(count),
        "recorded": np.zeros(count, dtype=bool),
    } | {name: np.array(column) for name, column in columns.items()}  # fmt: skip
    x, y = np.array(points, dtype=float).reshape(-1, 2).T
    return Candidates(naturalness=x, adversarialness=y, **given)


def eligible(kind, *arguments, **columns):
    return eligible_pairs(candidates(*arguments, **columns), RULES[kind]).tolist()


def test_danger_pairs_are_alike_in_naturalness_and_end_with_the_more_adversarial_one():
    points = [(0.5, 0.9), (0.55, 0.1), (0.7, 0.5), (0.5, 0.7)]
    assert eligible("danger", points) == [[1, 0], [1, 3]]


def test_naturalness_pairs_are_the_reverse_and_end_with_the_more_natural_one():
    points = [(0.9, 0.5), (0.1, 0.55), (0.5, 0.7), (0.7, 0.5)]
    assert eligible("naturalness", points) == [[1, 0], [1, 3]]


def test_faithfulness_pairs_are_alike_in_naturalness_and_end_with_the_recorded_one():
    points = [(0.5, 0.9), (0.52, 0.1), (0.58, 0.5), (0.9, 0.9)]
    recorded = [True, False, False, True]
    assert eligible("faithfulness", points, recorded=recorded) == [[1, 0], [2, 0]]


@pytest.mark.parametrize(
    ("difference", "found"),
    [
        pytest.param((0.125, 0.5), [], id="a-difference-of-a-tenth-is-too-large"),
        pytest.param((0.0625, 0.25), [], id="a-difference-of-three-tenths-is-too-small"),
        pytest.param((0.0625, 0.5), [[0, 1]], id="both-hold"),
    ],
)
def test_both_differences_count(difference, found):
    assert eligible("danger", [(0.25, 0.25), (0.25 + difference[0], 0.25 + difference[1])]) == found


@pytest.mark.parametrize("column", ["run", "start"])
def test_a_pair_never_leaves_its(column):
    assert eligible("danger", [(0.5, 0.1), (0.5, 0.9)], **{column: [0, 1]}) == []


def test_two_episodes_of_one_human_are_no_pair():
    assert eligible("danger", [(0.5, 0.1), (0.5, 0.9)], human=[3, 3]) == []


shares = st.floats(0, 1)
few = st.integers(0, 2)
somebody = st.tuples(shares, shares, few, few, few, st.booleans())


@given(st.lists(somebody, max_size=12), st.sampled_from(sorted(RULES)))
def test_the_eligible_pairs_are_exactly_those_that_the_rule_allows(people, kind):
    rows = np.array([row[:2] for row in people]).reshape(-1, 2)
    runs, starts, humans, recorded = (
        np.array([row[column] for row in people], dtype=dtype)
        for column, dtype in ((2, int), (3, int), (4, int), (5, bool))
    )
    found = eligible(kind, rows, run=runs, start=starts, human=humans, recorded=recorded)
    x, y = rows.T

    def allowed(i, j):
        near, far = (y, x) if kind == "naturalness" else (x, y)
        unlike = (
            recorded[i] != recorded[j] if kind == "faithfulness" else abs(far[i] - far[j]) > 0.3
        )
        together = runs[i] == runs[j] and starts[i] == starts[j] and humans[i] != humans[j]
        return together and abs(near[i] - near[j]) < 0.1 and unlike

    wanted = {pair for pair in combinations(range(len(people)), 2) if allowed(*pair)}
    assert {tuple(sorted(pair)) for pair in found} == wanted
    assert len(found) == len(wanted)


@st.composite
def draws(draw):
    """Pairs of episodes, each in a stratum, how many are wanted, and a seed."""
    members = st.lists(st.integers(0, 9), min_size=2, max_size=2, unique=True)
    pairs = draw(
        st.lists(st.tuples(members.map(sorted).map(tuple), st.integers(0, 2)), unique=True)
    )
    episodes = np.array([pair for pair, _ in pairs], dtype=int).reshape(-1, 2)
    return (
        episodes, np.array([s for _, s in pairs], dtype=int), draw(st.integers(1, 6)),
        draw(st.integers(0, 99)),
    )  # fmt: skip


@given(draws())
def test_no_episode_is_drawn_twice_and_no_pair_is_left_that_could_be_added(given_pairs):
    episodes, places, count, seed = given_pairs
    drawn = draw_pairs(episodes, places, count, seed=seed)
    shown = episodes[drawn].ravel().tolist()
    assert len(set(shown)) == len(shown)
    assert len(drawn) <= count
    if len(drawn) < count:
        assert all(set(pair) & set(shown) for pair in episodes.tolist())


@given(draws())
def test_a_stratum_lags_behind_only_where_it_has_no_pair_left(given_pairs):
    episodes, places, count, seed = given_pairs
    drawn = draw_pairs(episodes, places, count, seed=seed)
    shown = set(episodes[drawn].ravel().tolist())
    counts = {stratum: int((places[drawn] == stratum).sum()) for stratum in set(places.tolist())}
    for stratum, mine in counts.items():
        if max(counts.values()) - mine > 1:
            left = episodes[places == stratum].tolist()
            assert all(set(pair) & shown for pair in left)


@given(draws())
def test_equal_seeds_draw_equal_pairs(given_pairs):
    episodes, places, count, seed = given_pairs
    again = [draw_pairs(episodes, places, count, seed=seed).tolist() for _ in range(2)]
    assert again[0] == again[1]


@given(draws())
def test_with_reuse_every_eligible_pair_may_be_drawn_once(given_pairs):
    episodes, places, count, seed = given_pairs
    drawn = draw_pairs(episodes, places, count, seed=seed, reuse=True)
    assert len(set(drawn.tolist())) == len(drawn) == min(count, len(episodes))


@pytest.mark.parametrize("seed", range(10))
def test_a_draw_that_wastes_episodes_is_tried_again(seed):
    """Beginning with the pair in the middle leaves nothing for the others."""
    chain = np.array([[0, 1], [1, 2], [2, 3]])
    drawn = draw_pairs(chain, np.zeros(3, dtype=int), 2, seed=seed)
    assert sorted(drawn.tolist()) == [0, 2]


def test_other_seeds_draw_other_pairs():
    pairs = np.arange(40).reshape(20, 2)
    found = {tuple(draw_pairs(pairs, np.zeros(20, int), 3, seed=s).tolist()) for s in range(5)}
    assert len(found) > 1


def test_recorded_people_take_turns_as_runs_do():
    points = [(0.5, 0.5)] * 4
    everyone = candidates(points, recorded=[False, True, False, True], run=[0, 0, 0, 0])
    pairs = np.array([[0, 1], [0, 3], [2, 1], [2, 3]])
    assert strata(everyone, pairs, RULES["faithfulness"]).tolist() == [0, 1, 0, 1]
    assert strata(everyone, pairs, RULES["danger"]).tolist() == [0, 0, 0, 0]


STARTS, SEEDS = np.array([0, 0, 0, 1, 1]), np.array([10, 11, 12, 13, 13])
RETURNS = np.array([4.0, 1.0, 2.0, 9.0, 8.0])


@pytest.mark.parametrize(
    ("start", "shown", "expected"),
    [
        pytest.param(0, [50, 51], 2, id="the-median-return-of-its-start"),
        pytest.param(0, [12, 51], 1, id="else-the-nearest-that-is-not-from-a-seed-that-is-shown"),
        pytest.param(1, [13, 51], 3, id="else-also-from-a-seed-that-is-shown"),
        pytest.param(2, [50, 51], 0, id="else-of-any-start"),
    ],
)
def test_the_reference_is_typical_canonical_play(start, shown, expected):
    assert reference_of(RETURNS, STARTS, SEEDS, start=start, shown=shown) == expected


def test_without_canonical_play_there_is_no_reference():
    with pytest.raises(ValueError, match="no canonical episodes"):
        reference_of(np.zeros(0), np.zeros(0, int), np.zeros(0, int), start=0, shown=[])

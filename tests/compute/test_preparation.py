"""Draws of canonical play: one is everybody's, others are wholly new."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

from rigid.compute.preparation import prepare, settings_for
from rigid.compute.subject import Subject
from rigid.data.episodes import data_hash, save_episodes
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.policies.native import load_native
from tests.compute.tiny import TINY, FilmedReach, Notes


@pytest.fixture(scope="module")
def pair(base):
    """The toy robot and human, in the order that `record` takes them."""
    return tuple(load_native(base / "pair" / agent).policy for agent in ("robot", "human"))


@pytest.fixture(scope="module")
def prepared(base):
    """Measurements of the toy robot up to their first adversary, by their draw."""

    def of(draw):
        robot, human = (str(base / "pair" / agent) for agent in ("robot", "human"))
        subject = Subject(FilmedReach(), robot, human, canonical_draw=draw)
        return prepare(subject, TINY, settings_for(TINY))

    return {draw: of(draw) for draw in (0, 1)}


def referee_features(found):
    (fold,) = found.ruler.folds
    return np.concatenate([fold.train, fold.validation, fold.test])


@pytest.mark.parametrize(("draw", "search", "referee"), [(0, 0, 2**31), (1, 1, 2**31 + 1)])
def test_each_draw_records_with_two_seeds_of_its_own(draw, search, referee, prepared, pair):
    task, found = FilmedReach(), prepared[draw]
    seen = record(task, *pair, episodes=TINY.search_canonical, seed=search, provenance={})
    held = record(task, *pair, episodes=3 * TINY.referee_canonical, seed=referee, provenance={})
    np.testing.assert_array_equal(found.opponent.canonical, seen.features)
    np.testing.assert_array_equal(referee_features(found), held.features)


def test_another_draw_has_another_deviation_of_reward(prepared):
    assert prepared[0].opponent.reward_std != prepared[1].opponent.reward_std


def test_the_draw_is_part_of_what_a_run_directory_holds(measure, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        measure(tmp_path / "run", seeds=[0], listener=Notes(stop=lambda: True))
    path = tmp_path / "run" / "settings.json"
    stored = json.loads(path.read_text())
    assert stored["identity"]["canonical_draw"] == 0


def test_a_run_directory_that_names_no_draw_is_gone_on_with(single_run, single_copy, measure):
    path = single_copy / "settings.json"
    stored = json.loads(path.read_text())
    del stored["identity"]["canonical_draw"]
    path.write_text(json.dumps(stored))
    assert measure(single_copy, seeds=[0]).data == single_run.data


def test_episodes_beside_the_robot_belong_to_draw_0_alone(base, pair, tmp_path):
    robot = shutil.copytree(base / "pair" / "robot", tmp_path / "robot")
    beside = record(FilmedReach(), *pair, episodes=3, seed=5, provenance={})
    save_episodes(robot / "canonical.npz", beside)
    subject = Subject(FilmedReach(), str(robot), str(base / "pair" / "human"))
    first, second = (
        prepare(replace(subject, canonical_draw=draw), TINY, settings_for(TINY)).identity
        for draw in (0, 1)
    )
    assert first["canonical"] == data_hash(beside)
    assert second["canonical"] != data_hash(beside)


def test_recorded_people_cannot_be_drawn_again(base, pair, tmp_path):
    people = replace(
        record(FilmedReach(), *pair, episodes=12, seed=5, provenance={}), source="recorded"
    )
    save_episodes(tmp_path / "people.npz", people)
    subject = Subject(
        FilmedReach(), str(base / "pair" / "robot"), str(base / "pair" / "human"),
        canonical=str(tmp_path / "people.npz"), canonical_draw=2,
    )  # fmt: skip
    with pytest.raises(UserError, match=r"canonical_draw is 2, but .*people\.npz holds recorded"):
        prepare(subject, TINY, settings_for(TINY))


def test_a_negative_draw_is_refused():
    subject = Subject(FilmedReach(), "builtin:none", canonical_draw=-1)
    with pytest.raises(UserError, match=r"canonical_draw is -1, but must be 0 or more"):
        prepare(subject, TINY, settings_for(TINY))


def test_where_nobody_recorded_returns_the_human_says_what_canonical_behaviour_returns(
    base, pair, tmp_path
):
    robot, human = (str(base / "pair" / agent) for agent in ("robot", "human"))
    found = record(FilmedReach(), *pair, episodes=12, seed=5, provenance={})
    unknown = np.full(12, np.nan, np.float32)
    motion = replace(found, source="recorded", observations=None, actions=None, returns=unknown)
    blocks = []
    for name, episodes in (("motion", motion), ("told", replace(motion, returns=found.returns))):
        save_episodes(tmp_path / f"{name}.npz", episodes)
        subject = Subject(FilmedReach(), robot, human, canonical=str(tmp_path / f"{name}.npz"))
        blocks.append(prepare(subject, TINY, settings_for(TINY)).canonical)
    assert [block["return_source"] for block in blocks] == ["human", "episodes"]
    # Both are means of that human with that robot, over other episodes.
    assert blocks[0]["return"] == pytest.approx(blocks[1]["return"], rel=0.2)


def test_one_unknown_return_leaves_the_known_ones_in_force(base, pair, tmp_path):
    robot, human = (str(base / "pair" / agent) for agent in ("robot", "human"))
    found = record(FilmedReach(), *pair, episodes=24, seed=5, provenance={})
    told = np.full(24, -7.0, np.float32)
    told[3] = np.nan
    people = replace(
        found, source="recorded", observations=None, actions=None, returns=told,
        success=(told == -7).astype(np.float32),
    )  # fmt: skip
    save_episodes(tmp_path / "people.npz", people)
    subject = Subject(FilmedReach(), robot, human, canonical=str(tmp_path / "people.npz"))
    block = prepare(subject, TINY, settings_for(TINY)).canonical
    assert (block["return"], block["return_source"]) == (-7.0, "episodes")
    assert block["return_episodes"] in {block["episodes_referee"], block["episodes_referee"] - 1}

"""`frontier.json` as an object, and what is said about files that are none."""

from __future__ import annotations

import json
import math

import pytest

from rigid.compute.run.directory import alone_in
from rigid.errors import UserError
from rigid.frontier.result import Frontier, lacking, load_frontier, measured_points
from rigid.policies.native import CARD_FILE

POINT = {
    "id": "s0-r1-l1", "seed": 0, "round": 1, "lambda": 0.1, "naturalness": 0.9,
    "naturalness_own": None, "naturalness_all": {"step_k4": 0.9, "window16_k4": None},
    "adversarialness": 0.5, "return": 90.0, "success": None, "outcomes": {"helped": None},
    "peak_force": None, "impulse": None, "faults": 1, "episodes": 200, "converged": True,
    "on_frontier": True,
}  # fmt: skip
DATA = {
    "schema": 1, "task": "reach", "robot": "mine", "preset": "demo", "points": [POINT],
    "canonical": {"success": 1.0, "return": 100.0, "adversarialness": 0.0, "episodes": 40,
                  "source": "synthetic"},
    "worst_at": {"0.9": 0.5}, "worst_at_interval": {"0.9": None}, "auc": 0.6, "auc_natural": 0.4,
    "auc_interval": [0.5, 0.7], "auc_by_seed": {"0": 0.6}, "return_range": [0.0, 100.0],
    "env_steps": 1000, "core_seconds": 2.0, "wall_seconds": 1.0,
}  # fmt: skip


def stored(directory, data) -> Frontier:
    (directory / "frontier.json").write_text(json.dumps(data))
    return load_frontier(directory)


def test_a_result_offers_its_headline(tmp_path):
    frontier = stored(tmp_path, DATA)
    assert (frontier.auc, frontier.auc_natural) == (0.6, 0.4)
    assert frontier.auc_interval == (0.5, 0.7)
    assert frontier.worst_at == {"0.9": 0.5}
    assert frontier.points == [POINT]


def test_it_counts_the_seeds_that_found_a_human_of_a_naturalness(tmp_path):
    def point(seed, naturalness, faults=0):
        return {**POINT, "seed": seed, "naturalness": naturalness, "faults": faults}

    points = [point(0, 0.95), point(0, 0.99), point(1, 0.89), point(2, 0.9), point(3, 1.0, 200)]
    seeds = {str(seed): 0.5 for seed in range(4)}
    frontier = stored(tmp_path, {**DATA, "points": points, "auc_by_seed": seeds})
    assert frontier.seeds_at(0.9) == (2, 4)
    assert frontier.seeds_at(0.8) == (3, 4)


def test_it_says_where_canonical_play_stands():
    stands = "canonical play stands there"
    level = "a human at naturalness ≥ 0.9"
    assert lacking(6, 6, 0.9) is None
    assert lacking(2, 6, 0.9) == f"2 of 6 seeds found {level}; in the others {stands}"
    assert lacking(5, 6, 0.9) == f"5 of 6 seeds found {level}; in the other {stands}"
    assert lacking(0, 6, 0.9) == f"0 of 6 seeds found {level}: in all of them {stands}"
    assert lacking(0, 2, 0.9) == f"0 of 2 seeds found {level}: in both {stands}"
    assert lacking(0, 1, 0.9) == f"the seed found no human at naturalness ≥ 0.9: {stands}"
    assert lacking(0, 9, 0.9, called="searches").startswith("0 of 9 searches found")


def test_one_seed_has_no_interval(tmp_path):
    assert stored(tmp_path, {**DATA, "auc_interval": None}).auc_interval is None


def test_fields_of_later_versions_are_kept(tmp_path):
    assert stored(tmp_path, {**DATA, "mood": "good"}).data["mood"] == "good"


def test_a_run_without_a_result_says_how_to_finish_it(tmp_path):
    with pytest.raises(UserError, match=r"frontier\.json does not exist: run `rigid frontier`"):
        load_frontier(tmp_path)


@pytest.mark.parametrize(
    ("card", "said"),
    [
        ('{"agent": "robot"}', "is a policy (policy.json), not a measurement: measure it"),
        ("{", "is a policy (policy.json), not a measurement: measure it"),
        (
            '{"agent": "human"}',
            "is the policy of a human (policy.json), not a measurement: measure",
        ),
    ],
)
def test_a_policy_is_no_run_to_be_finished(tmp_path, card, said):
    (tmp_path / CARD_FILE).write_text(card)
    with pytest.raises(UserError) as error:
        load_frontier(tmp_path)
    assert str(error.value).startswith(f"{tmp_path} {said}")
    option = "--human" if "human" in card else "--robot"
    assert f"{option} {tmp_path} --out NEW`" in str(error.value)


def test_a_run_that_is_being_measured_is_waited_for(tmp_path):
    with (
        alone_in(tmp_path),
        pytest.raises(UserError, match=r"is being measured right now: wait for it$"),
    ):
        load_frontier(tmp_path)


@pytest.mark.parametrize("text", ["", "{", "\xff"])
def test_a_damaged_result_says_to_delete_it(tmp_path, text):
    (tmp_path / "frontier.json").write_text(text)
    with pytest.raises(UserError, match=r"frontier\.json is damaged: delete it and run"):
        load_frontier(tmp_path)


FOREIGN = {
    "newer": ({**DATA, "schema": 2}, "schema: Input should be 1"),
    "empty": ({"schema": 1}, "task: Field required"),
    "no file": ({**DATA, "range_file": "x"}, "range_file: Input should be a valid dictionary"),
    "a list": ([], "Input should be a valid dictionary"),
    "no anchor": ({**DATA, "canonical": None}, "canonical: Input should be a valid dictionary"),
    "no seed": ({**DATA, "auc_by_seed": {}}, "auc_by_seed: Dictionary should have at least 1"),
    "off the axis": (
        {**DATA, "points": [{**POINT, "naturalness": 1.5}]},
        "points.0.naturalness: Input should be less than or equal to 1",
    ),
}


@pytest.mark.parametrize(("data", "fault"), FOREIGN.values(), ids=FOREIGN)
def test_another_schema_is_refused_with_its_first_fault(tmp_path, data, fault):
    with pytest.raises(
        UserError, match=r"is not a frontier of schema 1 \(.*\): delete it"
    ) as error:
        stored(tmp_path, data)
    assert fault in str(error.value)


def test_points_become_what_the_statistics_take():
    (measured,) = measured_points([POINT])
    assert (measured.id, measured.seed, measured.naturalness) == ("s0-r1-l1", 0, 0.9)
    assert measured.faulted_share == 0.005
    assert measured.is_sound


def test_a_point_of_nothing_but_faults_is_not_sound():
    (measured,) = measured_points([{**POINT, "adversarialness": None, "faults": 200}])
    assert math.isnan(measured.adversarialness)
    assert not measured.is_sound

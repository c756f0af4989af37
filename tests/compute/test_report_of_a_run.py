"""From a run directory to the report: what the page is given."""

from __future__ import annotations

import json
import re
import shutil

import numpy as np
import pytest

from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.errors import UserError
from rigid.frontier.curve import hull_at
from rigid.frontier.result import Frontier, load_frontier
from rigid.report.gather import gather, replays, write_report
from rigid.report.payload import Learning, Payload
from tests.compute.tiny import TINY, FilmedReach
from tests.toys import ToyReach


@pytest.fixture(scope="module")
def payload(small_run):
    return gather(small_run, read_settings(RunDirectory(small_run.directory)))


@pytest.fixture
def broken_copy(small_run, tmp_path):
    """A copy of `small_run`, to be broken."""
    return shutil.copytree(small_run.directory, tmp_path / "run")


def test_the_page_gets_nothing_that_it_does_not_know(payload):
    assert set(payload) <= set(Payload.__annotations__)
    for curves in payload["learning"].values():
        assert set(curves) - {"return"} == set(Learning.__annotations__)


def test_the_band_is_the_mean_hull_of_the_seeds_with_its_interval(payload, small_run):
    band = payload["band"]
    anchor = small_run.data["canonical"]["adversarialness"]
    hulls = [
        hull_at(
            [(p["naturalness"], p["adversarialness"]) for p in small_run.points if p["seed"] == s],
            band["x"],
            anchor,
        )
        for s in (0, 1)
    ]
    np.testing.assert_allclose(band["mean"], np.mean(hulls, axis=0))
    assert (np.array(band["low"]) <= band["mean"]).all()
    assert (np.array(band["high"]) >= band["mean"]).all()


def test_the_band_of_one_seed_has_no_interval(single_run):
    band = gather(single_run, read_settings(RunDirectory(single_run.directory)))["band"]
    assert band["low"] is band["high"] is None


def test_every_adversary_has_its_learning_curves(payload, small_run):
    assert set(payload["learning"]) == {point["id"] for point in small_run.points}
    for curves in payload["learning"].values():
        assert {len(values) for values in curves.values()} == {TINY.iterations}


def test_every_adversary_has_its_discriminator_examined_but_for_old_runs(payload, broken_copy):
    judged = [set(seen["judged"]) for seen in payload["discriminators"].values()]
    assert set.union(*judged) == set(payload["learning"])
    assert all(seen["poses"] is None for seen in payload["discriminators"].values())
    shutil.rmtree(broken_copy / "discriminators")
    write_report(broken_copy)
    settings = read_settings(RunDirectory(broken_copy))
    assert gather(load_frontier(broken_copy), settings)["discriminators"] is None


def test_the_page_is_told_where_canonical_play_stands_in_the_words_of_the_terminal(small_run):
    wild = [{**point, "naturalness": 0.1} for point in small_run.points]
    frontier = Frontier(small_run.directory, {**small_run.data, "points": wild})
    told = gather(frontier, read_settings(RunDirectory(small_run.directory)))["lacking"]
    assert told == frontier.lacking_at(0.9)
    assert told.startswith("0 of 2 seeds found a human at naturalness ≥ 0.9")


def test_the_passive_human_is_a_reference(payload):
    assert {"naturalness", "adversarialness", "success"} <= set(payload["passive"])


def test_a_task_that_is_not_rigids_own_has_neither_scene_nor_replays(payload, small_run):
    assert payload["scene"] is payload["replays"] is None
    page = (small_run.directory / "report.html").read_text(encoding="utf-8")
    text = re.search(r'<script type="application/json"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert json.loads(text[1])["frontier"]["points"] == small_run.points


def test_a_task_that_can_show_episodes_gives_replays_beside_canonical_ones(small_run):
    shown = replays(small_run, FilmedReach())
    canonical = shown.pop("canonical")
    assert set(shown) == {point["id"] for point in small_run.points}
    for motions in shown.values():
        assert motions["worst"]["return"] <= motions["median"]["return"]
        for motion in motions.values():
            assert motion["frames"] == FilmedReach().horizon + 1
            assert motion["outcome"] in FilmedReach().outcome_names
            beside = canonical[str(motion["seed"])]
            assert beside["seed"] == motion["seed"]
            assert beside["outcome"] in FilmedReach().outcome_names


class Unseen(ToyReach):
    """A task whose snapshots are empty."""


def test_empty_snapshots_give_no_replays(broken_copy):
    for path in broken_copy.rglob("episodes.npz"):
        with np.load(path) as file:
            arrays = {name: file[name] for name in file.files}
        arrays["snapshots"] = np.zeros((2, 11, 0))
        np.savez_compressed(path, **arrays)
    assert replays(load_frontier(broken_copy), Unseen()) is None


@pytest.mark.parametrize("task", [{"name": "gone"}, None, "itch-scratching", {}], ids=repr)
def test_settings_of_strangers_need_name_no_task(small_run, task):
    settings = read_settings(RunDirectory(small_run.directory))
    settings["identity"]["task"] = task
    assert gather(small_run, settings)["scene"] is None


@pytest.mark.parametrize("text", ["{", '{"iteration": 0}', "[]", '{"iteration": null}'])
def test_damaged_learning_curves_are_named(broken_copy, text):
    (broken_copy / "adversaries" / "s1-r1-l2" / "metrics.jsonl").write_text(text)
    with pytest.raises(UserError, match=r"s1-r1-l2/metrics\.jsonl is damaged: measure again"):
        write_report(broken_copy)


def test_points_carry_what_was_said_of_whose_fault_they_are(broken_copy):
    said = {"solvable": 0.9, "verdict": "another policy copes", "regret": 0.5}
    (broken_copy / "blame.json").write_text(json.dumps({"s0-r1-l1": {**said, "robot": {}}}))
    frontier = load_frontier(broken_copy)
    first, second = gather(frontier, read_settings(RunDirectory(broken_copy)))["frontier"][
        "points"
    ][:2]
    assert first == {**frontier.points[0], **said}
    assert second == frontier.points[1]


@pytest.mark.parametrize("text", ["{", "[]", '{"s0-r1-l1": {}}', '{"s0-r1-l1": 3}'])
def test_a_damaged_blame_is_named(broken_copy, text):
    (broken_copy / "blame.json").write_text(text)
    with pytest.raises(UserError, match=r"blame\.json is damaged: delete it and run `rigid blame`"):
        write_report(broken_copy)


@pytest.mark.parametrize("length", [0, 100, -30])
def test_damaged_episodes_are_named(broken_copy, length):
    path = broken_copy / "adversaries" / "s0-r1-l1" / "episodes.npz"
    path.write_bytes(path.read_bytes()[:length])
    with pytest.raises(UserError, match=r"episodes\.npz cannot be read \(.*\): measure again"):
        replays(load_frontier(broken_copy), FilmedReach())


def test_an_id_that_leaves_the_run_directory_is_refused(broken_copy):
    data = json.loads((broken_copy / "frontier.json").read_text())
    data["points"][0]["id"] = "../../secret"
    (broken_copy / "frontier.json").write_text(json.dumps(data))
    with pytest.raises(UserError, match=r"has a point '\.\./\.\./secret', which is no id"):
        write_report(broken_copy)

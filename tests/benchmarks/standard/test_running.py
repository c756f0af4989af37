"""The order of the work, what is kept, and what goes on elsewhere. Measuring itself is planted."""

from __future__ import annotations

import io
import shutil
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import pytest

from benchmarks.standard import running
from benchmarks.standard.making import Workplace
from benchmarks.standard.plan import PLAN, Part
from benchmarks.standard.running import run
from rigid.compute.listening import Silence
from rigid.errors import UserError
from rigid.policies.native import load_card
from tests.benchmarks.standard.planting import SMALL, TRAINED, VANILLA, plant, planting, store_robot

KEPT = {"README.md", "costs.csv", "figure.svg", "seeds.csv", "table.csv", "robots", "runs"}


class Study(NamedTuple):
    """A whole study of two seeds."""

    out: Path
    results: Path
    measured: list[tuple[str, str, str]]
    """Robot, preset and seed, in this order."""
    accounts: list[str]
    """As they were written one after the other."""
    said: str


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """The one that all tests look at; copy its places before changing them."""
    base, accounts = tmp_path_factory.mktemp("study"), []
    out, results = base / "runs", base / "results"
    write = running.write_results

    def write_and_note(place):
        write(place)
        accounts.append((results / "README.md").read_text(encoding="utf-8"))

    store_robot(out)
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as said:
        parts = planting(patch)
        patch.setattr(running, "write_results", write_and_note)
        run(SMALL, out=out, results=results)
    return Study(out, results, parts, accounts, said.getvalue())


@pytest.fixture
def results(study, tmp_path):
    """What is kept of the finished study once more, to be broken."""
    return shutil.copytree(study.results, tmp_path / "results")


@pytest.fixture
def measured(monkeypatch):
    """What is measured, in this order."""
    return planting(monkeypatch)


@pytest.fixture
def undrawn(monkeypatch):
    """No figures, which take longer than all the rest."""
    monkeypatch.setattr(running, "draw", lambda *_: None)


def files_of(directory):
    return {path: path.read_bytes() for path in directory.rglob("*") if path.is_file()}


def test_every_robot_and_preset_has_a_seed_before_any_has_the_next(study):
    names = [(robot, preset) for robot, preset, _ in study.measured]
    assert [seed for _, _, seed in study.measured] == ["seed-0"] * 4 + ["seed-1"] * 4
    assert names[:4] == names[4:] == [
        ("vanilla", "standard"), ("vanilla", "paper"),
        ("i100-s0", "standard"), ("i100-s0", "paper"),
    ]  # fmt: skip


def test_an_account_is_written_after_each_pair(study):
    assert len(study.accounts) == 4
    assert "**So far 1 of 4 pairs are complete" in study.accounts[0]
    assert "- `vanilla`: **not enough seeds** (1 seed): `auc` -0.100" in study.accounts[0]
    assert "- `vanilla`: **not met** by `auc` and `auc_natural` (2 seeds)" in study.accounts[2]
    assert "All 4 pairs are complete." in study.accounts[3]


def test_what_is_kept_of_a_part_lies_beside_the_account(study):
    assert {path.name for path in study.results.iterdir()} == KEPT
    for part in SMALL.parts():
        kept = {path.name for path in (study.results / "runs" / part.place).iterdir()}
        assert kept == {"settings.json", "frontier.json"}


def test_a_robot_is_kept_with_the_canonical_episodes_that_its_searches_see(study):
    kept, made = study.results / "robots" / "i100-s0", study.out / "i100-s0" / "robot"
    names = {"policy.safetensors", "policy.json", "canonical.npz"}
    assert {path.name for path in kept.iterdir()} == names
    for name in names:
        assert (kept / name).read_bytes() == (made / name).read_bytes()


def test_a_trained_robot_is_measured_from_where_it_is_kept(study):
    place = Workplace(SMALL, study.out, study.results)
    subject = place.order(Part(TRAINED, "paper", 0), Silence()).subject
    assert subject.robot == str(study.results / "robots" / "i100-s0")
    assert load_card(Path(subject.robot)).provenance["seed"] == 0


def test_progress_says_how_much_is_left(study):
    assert "8 of 8 measurements to go: about" in study.said
    assert "measured: vanilla, standard, seed 0; 7 of 8 to go: about" in study.said
    assert "measured: i100-s0, paper, seed 1; 0 of 8 to go: about 0 s" in study.said


def test_another_machine_measures_nothing_again_and_writes_the_same(results, tmp_path, measured):
    before = files_of(results)
    for name in ("README.md", "costs.csv", "figure.svg", "seeds.csv", "table.csv"):
        (results / name).unlink()
    run(SMALL, out=tmp_path / "elsewhere", results=results)
    assert measured == []
    assert files_of(results) == before


@pytest.mark.usefixtures("undrawn")
def test_another_machine_measures_what_is_missing(results, tmp_path, measured):
    shutil.rmtree(results / "runs" / "vanilla" / "paper" / "seed-1")
    (results / "runs" / "i100-s0" / "standard" / "seed-0" / "frontier.json").unlink()
    run(SMALL, out=tmp_path / "elsewhere", results=results)
    assert measured == [("i100-s0", "standard", "seed-0"), ("vanilla", "paper", "seed-1")]


@pytest.mark.usefixtures("undrawn")
def test_parts_that_were_finished_before_an_interruption_are_kept(tmp_path, monkeypatch):
    store_robot(tmp_path / "runs")
    planting(monkeypatch, until=3)
    with pytest.raises(KeyboardInterrupt):
        run(SMALL, out=tmp_path / "runs", results=tmp_path / "results")
    shutil.rmtree(tmp_path / "runs")
    again = planting(monkeypatch)
    run(SMALL, out=tmp_path / "runs", results=tmp_path / "results")
    assert again[0] == ("i100-s0", "paper", "seed-0")
    assert len(again) == 5


def test_a_part_that_was_finished_and_not_kept_any_more_is_kept_now(study, results, tmp_path):
    part = Part(VANILLA, "paper", 1)
    shutil.rmtree(results / "runs" / part.place)
    place = Workplace(SMALL, tmp_path / "runs", results)
    plant(place.order(part, Silence()))
    place.keep_finished()
    kept = results / "runs" / part.place / "frontier.json"
    assert kept.read_bytes() == (study.results / "runs" / part.place / kept.name).read_bytes()


@pytest.mark.usefixtures("undrawn")
def test_more_seeds_add_to_those_that_are_kept(results, tmp_path, measured):
    run(SMALL.with_seeds([4]), out=tmp_path / "elsewhere", results=results)
    assert len(measured) == 4
    text = (results / "README.md").read_text(encoding="utf-8")
    assert "All 6 pairs are complete." in text
    assert "Search seeds 0, 1, 4." in text


def test_a_time_limit_begins_nothing_that_would_not_be_finished(tmp_path, measured, capsys):
    store_robot(tmp_path / "runs")
    run(SMALL, out=tmp_path / "runs", results=tmp_path / "results", limit=0.001)
    assert measured == []
    assert "no time for more: vanilla, standard, seed 0 would take about" in capsys.readouterr().out
    assert {path.name for path in (tmp_path / "results").iterdir()} == {"robots"}


@pytest.mark.usefixtures("undrawn")
def test_a_time_limit_that_is_long_enough_measures_everything(results, tmp_path, measured):
    shutil.rmtree(results / "runs" / "vanilla")
    run(SMALL, out=tmp_path / "elsewhere", results=results, limit=1e9)
    assert len(measured) == 4


def test_the_plan_pairs_three_different_robots_in_ten_seeds():
    assert [robot.name for robot in PLAN.robots] == ["vanilla", "i012-s2", "i100-s7"]
    assert PLAN.seeds == tuple(range(10))
    assert len(PLAN.parts()) == 60


def test_a_robot_that_was_made_otherwise_is_refused(results, tmp_path):
    other = replace(SMALL, recipe=replace(SMALL.recipe, episodes=7))
    with pytest.raises(UserError, match=r"i100-s0 was made with settings.episodes 96"):
        run(other, out=tmp_path / "elsewhere", results=results)

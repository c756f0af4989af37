"""The order of the work, and what a study that goes on does again. Measuring itself is planted."""

from __future__ import annotations

import io
import json
import shutil
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import pytest

from benchmarks.robots import OWN_HUMAN, RobotPlan
from benchmarks.standard import running
from benchmarks.standard.making import Part, Workplace
from benchmarks.standard.plan import PLAN, Robot
from benchmarks.standard.running import expected_seconds, run
from rigid.compute.run_directory import open_run
from rigid.errors import UserError
from rigid.policies.loading import BUNDLED, load_policy, policy_hash
from tests.benchmarks.standard.samples import frontier

VANILLA = Robot("vanilla")
TRAINED = Robot("i100-s0", RobotPlan(iterations=100, seed=0))  # As the bundled one was made.
SMALL = replace(PLAN, robots=(VANILLA, TRAINED), seeds=(0, 1))


class Study(NamedTuple):
    """A whole study of two seeds."""

    out: Path
    measured: list[tuple[str, str, int]]
    """Robot, preset and seed, in this order."""
    accounts: list[str]
    """As they were written one after the other."""
    said: str


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """The one that all tests look at; copy its `out` before changing it."""
    out, accounts = tmp_path_factory.mktemp("study") / "runs", []
    write = running.write_results

    def write_and_keep(place, results):
        write(place, results)
        accounts.append((results / "README.md").read_text(encoding="utf-8"))

    store_robot(out)
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as said:
        parts = planting(patch)
        patch.setattr(running, "write_results", write_and_keep)
        run(SMALL, out=out, results=out / "results")
    return Study(out, parts, accounts, said.getvalue())


@pytest.fixture
def copy(study, tmp_path):
    """Where the finished study lies once more, to be broken."""
    return shutil.copytree(study.out, tmp_path / "runs")


@pytest.fixture
def measured(monkeypatch):
    """What is measured, in this order."""
    return planting(monkeypatch)


def store_robot(out):
    """The robot that the study would train."""
    bundled = str(BUNDLED / "itch-scratching" / "vanilla")
    shutil.copytree(bundled, out / "i100-s0" / "robot")


def planting(patch):
    """Lets every measurement be planted at once, and returns the list of them."""
    parts = []

    def plant_and_note(place, part):
        parts.append((part.robot.name, part.preset, part.seed))
        plant(place, part)

    patch.setattr(Workplace, "measure", plant_and_note)
    return parts


def plant(place, part):
    """Adds a seed to a run directory: `standard` finds attacks that are lower by 0.2."""
    directory = place.run_directory(part.robot, part.preset)
    opened = open_run(directory, identity(place, part.preset), [part.seed], ["a test"])
    lower = 0.2 if part.preset == "standard" else 0.0
    found = frontier({seed: 0.5 + 0.1 * seed - lower for seed in opened.seeds})
    opened.directory.frontier.write_text(json.dumps(found.data), encoding="utf-8")


def identity(place, preset):
    """Of a measurement of the bundled robot, which is the trained one as well."""
    budget = place.plan.presets()[preset].describe()
    del budget["seeds"]
    robot, human = (
        policy_hash(load_policy(spec, task=place.task, agent=agent))
        for spec, agent in (("builtin:vanilla", "robot"), (OWN_HUMAN, "human"))
    )
    task = dict(place.task.describe())
    return {"preset": budget, "robot": robot, "human": human, "task": task, "measure": "lsgan"}


def test_every_robot_and_preset_has_a_seed_before_any_has_the_next(study):
    names = [(robot, preset) for robot, preset, _ in study.measured]
    assert [seed for _, _, seed in study.measured] == [0, 0, 0, 0, 1, 1, 1, 1]
    assert names[:4] == names[4:] == [
        ("vanilla", "standard"), ("vanilla", "paper"),
        ("i100-s0", "standard"), ("i100-s0", "paper"),
    ]  # fmt: skip


def test_an_account_is_written_after_each_seed(study):
    assert len(study.accounts) == 2
    assert "- `vanilla`: **not enough seeds** (1 seed): `auc` -0.100" in study.accounts[0]
    assert "- `vanilla`: **not met** by `auc` and `auc_natural` (2 seeds)" in study.accounts[1]


def test_tables_and_figure_lie_beside_the_account(study):
    names = {path.name for path in (study.out / "results").iterdir()}
    assert names == {"README.md", "costs.csv", "figure.svg", "seeds.csv", "table.csv"}


def test_progress_says_how_much_is_left(study):
    assert "8 of 8 measurements to go: about" in study.said
    assert "measured: vanilla, standard, seed 0; 7 of 8 to go: about" in study.said
    assert "measured: i100-s0, paper, seed 1; 0 of 8 to go: about 0 s" in study.said


def test_a_finished_study_measures_nothing_again_and_writes_the_same(copy, measured):
    before = {path.name: path.read_bytes() for path in (copy / "results").iterdir()}
    shutil.rmtree(copy / "results")
    run(SMALL, out=copy, results=copy / "results")
    assert measured == []
    assert {path.name: path.read_bytes() for path in (copy / "results").iterdir()} == before


def test_a_study_that_goes_on_measures_what_is_missing(tmp_path, measured):
    store_robot(tmp_path)
    place = Workplace(SMALL, tmp_path)
    for part in (*place.parts(0), Part(VANILLA, "standard", 1)):
        plant(place, part)
    run(SMALL, out=tmp_path, results=tmp_path / "results")
    assert measured == [
        ("vanilla", "paper", 1), ("i100-s0", "standard", 1), ("i100-s0", "paper", 1),
    ]  # fmt: skip


def test_a_measurement_that_was_interrupted_is_missing_with_all_its_seeds(copy):
    (copy / "vanilla" / "paper" / "frontier.json").unlink()
    place = Workplace(SMALL, copy)
    for seed in SMALL.seeds:
        assert place.missing(seed) == [Part(VANILLA, "paper", seed)]


def test_a_search_that_is_over_takes_no_more_training_time(tmp_path):
    place = Workplace(SMALL, tmp_path)
    before = expected_seconds(place, speed=1000.0)
    groups = tmp_path / "vanilla" / "paper" / "groups"
    groups.mkdir(parents=True)
    (groups / "s0-r3.json").touch()  # The last of three rounds.
    saved = before - expected_seconds(place, speed=1000.0)
    assert saved == pytest.approx(18 * 2 + 18 * 120 * 48 * 100 / 1000.0)


def test_a_robot_that_is_to_be_trained_takes_time(copy):
    known = expected_seconds(Workplace(SMALL, copy), speed=1000.0)
    shutil.rmtree(copy / "i100-s0" / "robot")
    more = expected_seconds(Workplace(SMALL, copy), speed=1000.0)
    assert more - known == pytest.approx(6 + 100 * 96 * 100 / 1000.0)


def test_a_measurement_of_another_preset_is_refused(copy):
    other = replace(SMALL, standard=replace(SMALL.standard, iterations=7))
    with pytest.raises(UserError, match=r"vanilla/standard was made with preset.iterations"):
        run(other, out=copy, results=copy / "results")


def test_presets_that_were_measured_with_another_measure_are_refused(copy):
    path = copy / "i100-s0" / "paper" / "settings.json"
    path.write_text(path.read_text(encoding="utf-8").replace("lsgan", "mmd"), encoding="utf-8")
    with pytest.raises(UserError, match=r"i100-s0/paper was made with measure mmd, .* lsgan"):
        run(SMALL, out=copy, results=copy / "results")


def test_the_plan_pairs_three_different_robots_in_ten_seeds():
    assert [robot.name for robot in PLAN.robots] == ["vanilla", "i012-s2", "i100-s7"]
    assert PLAN.seeds == tuple(range(10))

"""`rigid frontier` and `rigid report`: results on standard output, all else beside it."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from rigid.commands import measuring
from rigid.commands.measuring import FrontierCommand, headline
from rigid.compute import budget
from rigid.data.episodes import CanonicalEpisodes, save_episodes
from rigid.data.recording import record
from rigid.frontier.result import load_frontier
from rigid.policies.native import load_native, save_policy
from rigid.presets import PRESETS
from tests.compute.schema import FrontierFile
from tests.compute.tiny import TINY, FilmedReach
from tests.toys import untrained


@pytest.fixture
def frontier(rigid, toy_options, tmp_path):
    """`rigid frontier` on the toy task; later options win."""

    def command(*options):
        given = ["--preset", "tiny", "--out", tmp_path / "run", *options]
        return rigid("frontier", *toy_options, *given)

    return command


def test_json_is_all_that_stands_on_standard_output(frontier, tmp_path):
    code, out, err = frontier("--seeds", "0", "--lambdas", "0,inf", "--json")
    assert code == 0
    FrontierFile.model_validate_json(out)
    assert [point["lambda"] for point in json.loads(out)["points"]] == [0.0, "inf"]
    assert json.loads(out) == load_frontier(tmp_path / "run").data
    assert (tmp_path / "run" / "report.html").exists()
    steps = 2 * TINY.iterations * TINY.episodes * FilmedReach().horizon
    told = " ".join(err.split())  # A long name wraps.
    assert told.startswith("preparing ")
    assert f"(preset tiny) {steps:,} training steps; about " in told


def test_a_finished_directory_says_so_and_shows_its_headline(frontier, small_run):
    shown = small_run.directory
    before = {path: path.stat().st_mtime_ns for path in shown.rglob("*") if path.is_file()}
    code, out, err = frontier("--out", shown)
    assert code == 0
    assert f"{shown} is already complete; nothing to do" in " ".join(err.split())
    assert out == headline(small_run, shown / "report.html") + "\n"
    assert {path: path.stat().st_mtime_ns for path in before} == before


def test_the_headline_names_every_number_with_its_interval(small_run):
    text = headline(small_run, small_run.directory / "report.html")
    data = small_run.data
    low, high = data["auc_interval"]
    assert f"AUC                          {data['auc']:.2f}  [{low:.2f}, {high:.2f}]" in text
    assert "6 adversaries, 2 seeds; lower is better" in text
    assert "not a bound" in text
    assert text.endswith(f"report: {small_run.directory / 'report.html'}")


def test_the_headline_has_no_interval_from_one_seed_and_shows_the_stamp(small_run):
    one = {"auc_interval": None, "auc_by_seed": {"0": 0.5}, "stamp": "demo: not for publication"}
    text = headline(replace(small_run, data={**small_run.data, **one}), small_run.directory)
    assert "[one seed: no interval]" in text
    assert "6 adversaries, 1 seed; " in text
    assert "\n  demo: not for publication\n" in text


def test_the_headline_says_where_canonical_play_stands_for_humans_that_were_not_found(small_run):
    far = [{**point, "naturalness": 0.2} for point in small_run.points]
    near = [{**far[0], "naturalness": 0.93}, *far[1:]]
    texts = [
        headline(replace(small_run, data={**small_run.data, "points": points}), Path("r"))
        for points in (far, near)
    ]
    assert "0 of 2 seeds found a human at naturalness ≥ 0.9: in both canonical play" in texts[0]
    assert "1 of 2 seeds found a human at naturalness ≥ 0.9; in the other canonical" in texts[1]


def test_the_headline_says_that_a_robot_does_not_do_its_task_yet(small_run):
    def said(success):
        canonical = {**small_run.data["canonical"], "success": success}
        data = {**small_run.data, "canonical": canonical}
        return " ".join(headline(replace(small_run, data=data), Path("r")).split())

    assert "canonical play succeeds in 12 % of episodes: a robot that does not do its" in said(0.12)
    assert "canonical play succeeds" not in said(0.5)
    assert "canonical play succeeds" not in said(None)


def test_other_settings_exit_with_2_and_the_first_difference(frontier, small_run):
    code, out, err = frontier("--out", small_run.directory, "--lambdas", "1")
    assert (code, out) == (2, "")
    message = err[err.index("rigid: ") :]
    assert (
        "holds a measurement with other settings: lambdas is None there and [1.0] here" in message
    )


BAD_INPUT = {
    "task": (["--task", "toy-rich"], "unknown task 'toy-rich', did you mean 'toy-reach'?"),
    "robot": (["--robot", "builtin:vanila"], "robot 'builtin:vanila' is unknown for task"),
    "robot's folder": (["--robot", "nowhere"], "robot 'nowhere' is no directory: give builtin:"),
    "human": (["--human", "builtin:pasive"], "did you mean 'builtin:passive'?"),
    "preset": (["--preset", "standart"], "preset 'standart' is unknown, did you mean 'standard'?"),
    "strange preset": (["--preset", "xyz"], "preset 'xyz' is unknown; presets: demo, standard, "),
    "seeds": (["--seeds", "0.5"], "--seeds '0.5': '0.5' is no seed"),
    "lambdas": (["--lambdas", "a"], "--lambdas 'a': write numbers"),
    "memory": (["--memory", "0"], "memory is 0, but an adversary sees at least 1 observation"),
    "budget": (["--budget", "30"], "--budget '30': write a time as 90s, 30m or 2h"),
    "a cluster's budget": (
        ["--budget", "30m", "--executor", "ray"],
        "--budget times this machine, not --executor ray: leave it out, or choose --preset and",
    ),
    "short budget": (["--budget", "1s"], "--budget is too short for preset 'tiny'"),
    "canonical": (["--canonical", "none.npz"], "none.npz does not exist: record it"),
}


@pytest.mark.parametrize(("options", "message"), BAD_INPUT.values(), ids=BAD_INPUT)
def test_bad_input_exits_with_2_and_writes_nothing(frontier, tmp_path, options, message):
    code, out, err = frontier(*options)
    assert (code, out) == (2, "")
    assert err.startswith("rigid: ")  # Nobody said that anything begins.
    assert message in err
    assert "Traceback" not in err
    assert not (tmp_path / "run").exists()


def test_a_place_that_cannot_be_written_exits_with_2_at_once(frontier, tmp_path):
    (tmp_path / "file").touch()
    code, _, err = frontier("--out", tmp_path / "file" / "run")
    assert code == 2
    assert "choose another place with --out" in err


def test_a_robot_of_another_size_exits_with_2(frontier, tmp_path):
    task = FilmedReach()
    save_policy(
        untrained(replace(task.robot, observation_size=5)), tmp_path / "robot",
        agent="robot", task=task.describe(), provenance={},
    )  # fmt: skip
    code, _, err = frontier("--robot", tmp_path / "robot")
    assert code == 2
    assert "maps 5 observations to 1 actions, but the robot of 'toy-reach' maps 2 to 1" in err


@pytest.fixture
def episodes(toys) -> CanonicalEpisodes:
    players = (load_native(toys / agent).policy for agent in ("robot", "human"))
    return record(FilmedReach(), *players, episodes=4, seed=0, provenance={})


def test_canonical_episodes_of_another_task_exit_with_2(frontier, episodes, tmp_path):
    save_episodes(tmp_path / "c.npz", replace(episodes, task={"name": "itch-scratching"}))
    code, _, err = frontier("--canonical", tmp_path / "c.npz")
    assert code == 2
    assert "holds episodes of task 'itch-scratching', not 'toy-reach'" in err


def test_canonical_episodes_with_nan_exit_with_2(frontier, episodes, tmp_path, monkeypatch):
    episodes.features[2, 3, 1] = float("nan")
    with monkeypatch.context() as unchecked:
        unchecked.setattr("rigid.data.episodes.check_values", lambda *_, **__: None)
        save_episodes(tmp_path / "c.npz", episodes)
    code, _, err = frontier("--canonical", tmp_path / "c.npz")
    assert code == 2
    assert "not finite, the first in episode 2, step 3, feature 'goal'" in err


def test_too_few_recorded_people_are_refused(frontier, episodes, tmp_path):
    save_episodes(tmp_path / "c.npz", replace(episodes, source="recorded"))
    code, _, err = frontier("--canonical", tmp_path / "c.npz")
    assert code == 2
    assert "c.npz holds 4 recorded episodes, but the referee needs at least 12: record" in err


@pytest.fixture
def fitted(toys, monkeypatch):
    """The preset that `--budget` gives on a machine of one training step a second."""
    del toys
    monkeypatch.setattr(budget, "working_speed", lambda *_: 1.0)

    horizon = FilmedReach().horizon
    half = (TINY.env_steps(horizon) + TINY.scoring_steps(TINY.adversaries, horizon)) / 2

    def fit(out, *, seconds=budget.FIXED_SECONDS + half, seeds=None, lambdas=None):
        options = FrontierCommand(out=out, task="toy-reach", preset="tiny", seeds=seeds)
        return measuring._fitted(TINY, options, options.open_task(), seconds, lambdas)

    return fit


def test_a_budget_of_half_the_steps_leaves_one_of_two_seeds(fitted, tmp_path):
    assert fitted(tmp_path / "new") == replace(TINY, seeds=(0,))


def test_a_budget_counts_the_lambdas_that_are_really_trained(fitted, tmp_path):
    assert fitted(tmp_path / "new", lambdas=(0.1,)) == TINY


def test_a_run_keeps_the_budget_that_it_was_begun_with(fitted, small_run):
    assert fitted(small_run.directory, seconds=1.0) == TINY


def test_seeds_can_join_a_run_that_was_begun_with_a_budget(fitted, small_run):
    assert fitted(small_run.directory, seconds=1.0, seeds="0,1").seeds == TINY.seeds


def test_report_is_rebuilt_where_it_was_or_elsewhere(rigid, small_run, tmp_path):
    directory = shutil.copytree(small_run.directory, tmp_path / "run")
    first = (directory / "report.html").read_bytes()
    (directory / "report.html").unlink()
    assert rigid("report", directory)[:2] == (0, f"{directory / 'report.html'}\n")
    assert (directory / "report.html").read_bytes() == first
    assert rigid("report", directory, "--out", tmp_path / "r.html")[1] == f"{tmp_path / 'r.html'}\n"
    assert (tmp_path / "r.html").read_bytes() == first


@pytest.mark.parametrize("name", ["frontier.json", "settings.json"])
def test_report_of_an_unfinished_run_exits_with_2(rigid, small_run, tmp_path, name):
    directory = shutil.copytree(small_run.directory, tmp_path / "run")
    (directory / name).unlink()
    code, out, err = rigid("report", directory)
    assert (code, out) == (2, "")
    assert f"{directory / name} does not exist" in err


def test_presets_of_the_product_are_those_of_the_contract():
    assert {"demo", "standard", "paper"} <= set(PRESETS)
    assert len(PRESETS["standard"].seeds) == 8
    assert PRESETS["paper"].adversaries == 54
    assert PRESETS["demo"].stamp == "demo: not for publication"

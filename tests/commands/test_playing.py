"""`rigid record` and `rigid evaluate`: files that can be read again, and numbers."""

from __future__ import annotations

import json

import pytest

from rigid.compute.evaluation import evaluate
from rigid.data.episodes import load_episodes
from rigid.policies.native import load_native
from tests.compute.tiny import FilmedReach


def test_record_writes_episodes_that_the_task_accepts(rigid, toy_options, tmp_path):
    out = tmp_path / "deep" / "canonical.npz"
    code, text, _ = rigid("record", *toy_options, "--episodes", 7, "--seed", 3, "--out", out)
    assert code == 0
    assert text == f"7 episodes, success 0.000: {out}\n"
    episodes = load_episodes(out, task=FilmedReach())
    assert len(episodes) == 7
    assert episodes.source == "synthetic"
    assert episodes.provenance["seed"] == 3
    assert episodes.provenance["robot"] == toy_options[3]


def test_record_needs_a_place_before_it_plays(rigid, toy_options, tmp_path):
    (tmp_path / "file").touch()
    code, _, err = rigid("record", *toy_options, "--out", tmp_path / "file" / "c.npz")
    assert code == 2
    assert "cannot write to" in err


def test_record_refuses_a_directory_as_its_file(rigid, toy_options, tmp_path):
    code, _, err = rigid("record", *toy_options, "--episodes", 1, "--out", tmp_path)
    assert code == 2
    assert f"cannot write to {tmp_path} (Is a directory)" in err


WORK = {
    "record": ("rigid.data.recording.record", ["--out"]),
    "verify": ("rigid.compute.verifying.plan_verification", ["--json"]),
    "bench": ("rigid.commands.benchmarking._measured", ["--json"]),
}


@pytest.mark.parametrize("command", WORK)
def test_a_file_that_cannot_be_written_is_refused_before_any_work(rigid, monkeypatch, command):
    work, options = WORK[command]
    monkeypatch.setattr(work, lambda *_, **__: pytest.fail("it has begun"))
    code, out, err = rigid(command, *options, "/proc/result")  # Where root cannot write either.
    assert (code, out) == (2, "")
    assert "rigid: cannot write to /proc/result (" in err
    assert err.endswith(f"choose another place with {options[0]}\n")


def test_evaluate_prints_what_python_gives(rigid, toys, toy_options):
    code, out, err = rigid("evaluate", *toy_options, "--episodes", 5, "--seed", 2, "--json")
    assert (code, err) == (0, "")
    players = (load_native(toys / agent).policy for agent in ("robot", "human"))
    assert json.loads(out) == evaluate(FilmedReach(), *players, episodes=5, seed=2)


def test_evaluate_prints_a_line_for_each_number(rigid, toy_options):
    code, out, _ = rigid("evaluate", *toy_options, "--human", "builtin:passive", "--episodes", 3)
    assert code == 0
    lines = dict(line.split(maxsplit=1) for line in out.splitlines())
    assert lines["episodes"] == "3"
    assert lines["outcomes"] == "helped 0.000, unhelped 1.000"
    assert lines["return"] == "-10.000"


@pytest.mark.parametrize("command", [["evaluate"], ["record", "--out", "c.npz"]])
@pytest.mark.parametrize(("option", "value"), [("--episodes", 0), ("--seed", -1)])
def test_impossible_counts_exit_with_2(rigid, toy_options, command, option, value):
    code, _, err = rigid(*command, *toy_options, f"{option}={value}")
    assert code == 2
    assert f"rigid: {option} is {value}, but must be at least" in err

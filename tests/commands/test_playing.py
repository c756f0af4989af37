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
    "verify": ("rigid.compute.verification.plan.plan_verification", ["--json"]),
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


def test_play_that_takes_its_time_shows_a_bar_and_ends_in_the_same_numbers(
    rigid, toy_options, monkeypatch
):
    from rigid.commands.terminal import progress

    command = ("evaluate", *toy_options, "--episodes", 5, "--seed", 2, "--json")
    _, quick, _ = rigid(*command)
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    code, slow, err = rigid(*command)
    assert (code, slow) == (0, quick)
    assert "playing 5 episodes: 100 %" in err


def test_evaluate_calls_forces_unknown_where_a_task_has_none(rigid):
    code, out, _ = rigid("evaluate", "--task", "analytic/hand-tracking", "--episodes", 2,
                         "--robot", "builtin:tracker")  # fmt: skip
    lines = dict(line.split(maxsplit=1) for line in out.splitlines())
    assert code == 0
    assert (lines["peak_force"], lines["impulse"]) == ("unknown", "unknown")


def test_evaluate_prints_what_python_gives(rigid, toys, toy_options):
    code, out, err = rigid("evaluate", *toy_options, "--episodes", 5, "--seed", 2, "--json")
    assert (code, err) == (0, "")
    players = (load_native(toys / agent).policy for agent in ("robot", "human"))
    found = json.loads(out)
    ends = list(FilmedReach().return_range)
    assert (found.pop("return_range"), found.pop("range_source")) == (ends, "task")
    assert found.pop("range_file") is None
    assert found == evaluate(FilmedReach(), *players, episodes=5, seed=2)


def test_evaluate_prints_a_line_for_each_number(rigid, toy_options):
    code, out, _ = rigid("evaluate", *toy_options, "--human", "builtin:passive", "--episodes", 3)
    assert code == 0
    lines = dict(line.split(maxsplit=1) for line in out.splitlines())
    assert lines["episodes"] == "3"
    assert lines["outcomes"] == "helped 0.000, unhelped 1.000"
    assert lines["return"] == "-10.000"


PASSIVE = ("--human", "builtin:passive", "--episodes", 3)
"""Episodes that return −10 with the toy robot."""


@pytest.mark.parametrize("expected", ["-10±0.5", "-9+-2", "-10+-0"])
def test_evaluate_exits_with_0_when_the_return_is_the_expected_one(rigid, toy_options, expected):
    code, out, err = rigid("evaluate", *toy_options, *PASSIVE, f"--expect-return={expected}")
    assert (code, err) == (0, "")
    assert "ok yes" in out


def test_evaluate_exits_with_1_when_the_return_is_another_one(rigid, toy_options):
    options = (*toy_options, *PASSIVE, "--expect-return", "431±15", "--json")
    code, out, err = rigid("evaluate", *options)
    assert code == 1
    verdict = {"mean": 431.0, "tolerance": 15.0, "standard_error": 0.0, "ok": False}
    assert json.loads(out)["expected_return"] == verdict
    assert err == (
        "rigid: the mean return -10.000 (standard error 0.000, 3 episodes) lies outside of "
        "431 ± 15: another robot, task, human or normaliser than you expect?\n"
    )


@pytest.mark.parametrize("text", ["431", "431±", "±3", "nan±1", "1±-2", "1±inf", "a±b"])
def test_an_expected_return_without_sense_is_refused(rigid, toy_options, text):
    code, _, err = rigid("evaluate", *toy_options, f"--expect-return={text}")
    assert code == 2
    assert f"rigid: --expect-return '{text}'" in err


def test_a_robot_of_another_library_plays_and_stumbles_without_a_traceback(
    rigid, toy_options, tmp_path
):
    from tests.policies.graphs import chain, linear, save

    task, human = toy_options[:2], toy_options[4:]
    good, bad = save(tmp_path / "arm.onnx", linear()), save(tmp_path / "bad.onnx", chain("Log"))
    code, out, _ = rigid("evaluate", *task, "--robot", good, *human, "--episodes", 2)
    assert code == 0
    assert "return" in out
    code, out, err = rigid("evaluate", *task, "--robot", bad, *human, "--episodes", 2)
    assert (code, out) == (2, "")
    assert err.startswith(f"rigid: robot '{bad}', step 1: answers actions that are not finite")


@pytest.mark.parametrize("command", [["evaluate"], ["record", "--out", "c.npz"]])
@pytest.mark.parametrize(("option", "value"), [("--episodes", 0), ("--seed", -1)])
def test_impossible_counts_exit_with_2(rigid, toy_options, command, option, value):
    code, _, err = rigid(*command, *toy_options, f"{option}={value}")
    assert code == 2
    assert f"rigid: {option} is {value}, but must be at least" in err

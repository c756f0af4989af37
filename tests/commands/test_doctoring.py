"""`rigid doctor` on the command line."""

from __future__ import annotations

import pytest

from rigid.commands.doctoring import table
from rigid.compute.doctor import domain as doctor
from rigid.compute.doctor.domain import Diagnosis
from rigid.doctor.verdict import TITLES, Verdict, skipped

GOOD = Verdict("features", "pass", "They vary.")
BAD = Verdict("data", "fail", "Too few.", "Record more.")
ABOUT = {"task": "toy-reach", "robot": "r", "human": "h", "features": "default"}


@pytest.fixture
def examined(rigid, toy_options, tmp_path, monkeypatch):
    """`rigid doctor` that finds the given verdicts; returns what the command returns."""

    def of(*verdicts, options=()):
        def found(subject, preset, *, out, listener):
            del subject, preset, out, listener
            return Diagnosis(verdicts, ABOUT)

        monkeypatch.setattr(doctor, "examine", found)
        return rigid("doctor", *toy_options, "--out", tmp_path / "d", *options)

    return of


def test_a_failed_verdict_exits_with_1_and_says_what_to_do(examined, tmp_path):
    code, out, _ = examined(GOOD, BAD)
    assert code == 1
    assert "  FAIL  Enough canonical data\n        Too few.\n        Record more." in out
    assert "fails: Enough canonical data" in out
    assert out.endswith(f"{tmp_path / 'd' / 'doctor.html'}\n")
    assert (tmp_path / "d" / "doctor.html").exists()


def test_warnings_and_passes_exit_with_0(examined):
    code, out, _ = examined(GOOD, Verdict("scan", "warn", "A jump."))
    assert code == 0
    assert "no verdict fails: `rigid frontier` may begin" in out


def test_json_is_all_that_stands_on_standard_output(examined):
    import json

    code, out, _ = examined(BAD, options=["--json"])
    assert code == 1
    assert json.loads(out)["verdicts"][0]["advice"] == "Record more."


def test_every_step_stands_in_the_table():
    text = table([skipped(step, "why not") for step in TITLES])
    assert all(title in text for title in TITLES.values())


BAD_INPUT = {
    "a human alone": (["--human", "h"], "--human is the human of a --robot: name both, or neither"),
    "data alone": (["--canonical", "c.npz"], "--canonical needs the --robot that it was recorded"),
    "budget": (["--budget", "soon"], "--budget 'soon': write a time as 90s, 30m or 2h"),
}


@pytest.mark.parametrize(("options", "message"), BAD_INPUT.values(), ids=BAD_INPUT)
def test_bad_input_exits_with_2(rigid, toys, tmp_path, options, message):
    del toys
    code, out, err = rigid("doctor", "--task", "toy-reach", "--out", tmp_path / "d", *options)
    assert (code, out) == (2, "")
    assert message in err


def test_a_directory_of_something_else_exits_with_2(examined, tmp_path):
    (tmp_path / "d").mkdir()
    (tmp_path / "d" / "notes.txt").touch()
    code, _, err = examined(GOOD)
    assert code == 2
    assert "notes.txt, which no examination made" in err

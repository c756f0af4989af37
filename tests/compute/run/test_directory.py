"""Which directories a measurement may use, and what is said about the others."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from rigid.compute.run import directory as run_directory
from rigid.compute.run.directory import (
    alone_in,
    check_place,
    is_being_measured,
    open_run,
    read_settings,
)
from rigid.compute.run.provenance import provenance
from rigid.errors import UserError

ENTER = """
import sys
from pathlib import Path
from rigid.compute.run.directory import alone_in
from rigid.errors import UserError
try:
    with alone_in(Path(sys.argv[1])):
        pass
except UserError as error:
    print(error)
"""
IDENTITY = {"preset": {"iterations": 20, "name": "tiny"}, "task": {"name": "toy"}}


def begin(path: Path, seeds=(0,), **changes):
    return open_run(path, {**IDENTITY, **changes}, seeds, ["rigid", "frontier"])


def test_a_new_directory_is_made_with_its_settings(tmp_path):
    opened = begin(tmp_path / "runs" / "new", seeds=(2, 0))
    assert opened.seeds == (0, 2)
    stored = read_settings(opened.directory)
    assert stored["identity"] == IDENTITY
    assert stored["provenance"]["command"] == "rigid frontier"


def test_two_processes_do_not_measure_in_one_directory(tmp_path):
    run = tmp_path / "run"
    with alone_in(run):
        check_place(run)  # The lock makes it no foreign directory.
        other = subprocess.run(
            [sys.executable, "-c", ENTER, str(run)],
            capture_output=True, text=True, check=False, timeout=120,
        )  # fmt: skip
        assert other.stdout == (
            f"another process is measuring in {run}: wait for it, or choose another directory "
            "with --out\n"
        )
    with alone_in(run):
        pass
    assert not list(run.iterdir())


def test_a_lock_ends_with_its_process(tmp_path):
    code = ENTER.replace("pass", "import os; os._exit(9)")
    subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=False, timeout=120)
    assert (tmp_path / ".lock").exists()
    with alone_in(tmp_path):
        pass


def test_whether_a_run_is_being_measured_is_seen_without_a_trace(tmp_path):
    assert not is_being_measured(tmp_path)
    with alone_in(tmp_path):
        assert is_being_measured(tmp_path)
        assert is_being_measured(tmp_path)
    (tmp_path / ".lock").touch()  # Of a process that was killed.
    assert not is_being_measured(tmp_path)
    with alone_in(tmp_path):
        pass


def test_the_same_settings_go_on_and_change_nothing(tmp_path):
    first = begin(tmp_path)
    before = first.directory.settings.read_bytes()
    assert begin(tmp_path) == first
    assert first.directory.settings.read_bytes() == before


def test_seeds_of_earlier_commands_stay(tmp_path):
    begin(tmp_path, seeds=(0, 3))
    assert begin(tmp_path, seeds=(1,)).seeds == (0, 1, 3)
    assert begin(tmp_path, seeds=(3,)).seeds == (0, 1, 3)


def test_a_result_that_lacks_a_seed_is_taken_away_with_its_report(tmp_path):
    run = begin(tmp_path, seeds=(0,)).directory
    for path in (run.frontier, run.report):
        path.write_text("old")
    begin(tmp_path, seeds=(0,))
    assert run.frontier.exists()
    begin(tmp_path, seeds=(1,))
    assert not run.frontier.exists()
    assert not run.report.exists()


def test_other_settings_are_named_and_nothing_is_overwritten(tmp_path):
    settings = begin(tmp_path).directory.settings
    before = settings.read_bytes()
    with pytest.raises(
        UserError,
        match=r"preset\.iterations is 20 there and 40 here \(preset or budget\); choose anot",
    ):
        begin(tmp_path, seeds=(7,), preset={"iterations": 40, "name": "tiny"})
    assert settings.read_bytes() == before


def test_a_long_value_is_cut_in_the_message(tmp_path):
    begin(tmp_path, robot="a" * 64)
    with pytest.raises(UserError, match=r"robot is a{37}… there and b{37}… here"):
        begin(tmp_path, robot="b" * 64)


def test_a_directory_of_something_else_is_refused(tmp_path):
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(UserError, match=r"is not empty and holds no measurement .*--out"):
        begin(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_what_a_run_left_that_was_killed_at_its_first_write_does_not_count(tmp_path):
    (tmp_path / ".settings.json.4711.tmp").touch()
    assert begin(tmp_path).seeds == (0,)


@pytest.mark.parametrize("below", ["", "runs", "runs/first"])
def test_a_place_below_a_file_cannot_be_written(tmp_path, below):
    (tmp_path / "file").touch()
    with pytest.raises(UserError, match=r"cannot write to .*file.* \(.*\): choose another place"):
        check_place(tmp_path / "file" / below)


def test_a_file_system_that_takes_no_files_cannot_be_written():
    """Root has every permission there."""
    with pytest.raises(UserError, match=r"cannot write to /proc/runs \(.*\): choose another place"):
        check_place(Path("/proc/runs"))


def test_a_place_without_permission_cannot_be_written(tmp_path, monkeypatch):
    monkeypatch.setattr(run_directory.os, "access", lambda *_: False)  # Root may write anywhere.
    with pytest.raises(UserError, match=r"cannot write to .*new \(no permission\)"):
        check_place(tmp_path / "new")


def test_a_finished_run_may_be_read_only(tmp_path, monkeypatch):
    begin(tmp_path).directory.frontier.touch()
    monkeypatch.setattr(run_directory.os, "access", lambda *_: False)
    assert begin(tmp_path).seeds == (0,)


def test_checking_a_place_makes_nothing(tmp_path):
    check_place(tmp_path / "new")
    assert not list(tmp_path.iterdir())


def stored_but(tmp_path, **changes) -> str:
    stored = read_settings(begin(tmp_path / "sound").directory)
    return json.dumps({**stored, **changes})


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", '{"schema": 1}', "null", b"\xff\xfe"],
    ids=["empty", "cut off", "a list", "without seeds", "null", "no text"],
)
def test_damaged_settings_are_refused(tmp_path, text):
    path = tmp_path / "settings.json"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(UserError, match=r"settings\.json is damaged: choose another directory"):
        begin(tmp_path)


def test_settings_of_another_program_are_not_called_damaged(tmp_path):
    (tmp_path / "settings.json").write_text('{"editor.fontSize": 12}')
    with pytest.raises(UserError, match=r"settings\.json is of something else: choose another dir"):
        begin(tmp_path)


@pytest.mark.parametrize(
    "changes",
    [{"seeds": "0"}, {"seeds": [0.5]}, {"identity": "mine"}, {"provenance": {"versions": None}}],
    ids=repr,
)
def test_settings_of_the_wrong_type_are_damaged(tmp_path, changes):
    (tmp_path / "settings.json").write_text(stored_but(tmp_path, **changes))
    with pytest.raises(UserError, match=r"settings\.json is damaged"):
        begin(tmp_path)


def test_settings_of_a_newer_schema_are_refused(tmp_path):
    (tmp_path / "settings.json").write_text('{"schema": 2}')
    with pytest.raises(UserError, match=r"has schema 2, this RIGID reads 1"):
        begin(tmp_path)


def test_a_library_that_changed_since_is_warned_about(tmp_path):
    settings = begin(tmp_path).directory.settings
    stored = json.loads(settings.read_text())
    stored["provenance"]["versions"]["jax"] = "0.0.1"
    settings.write_text(json.dumps(stored))
    (warning,) = begin(tmp_path).warnings
    assert warning.startswith("this run was begun with jax 0.0.1, now it is ")


def test_provenance_names_versions_machine_and_command():
    made_by = provenance(["rigid", "frontier", "--seeds", "0"])
    assert made_by["command"] == "rigid frontier --seeds 0"
    assert {"mujoco", "jax", "numpy"} <= set(made_by["versions"])


def test_a_repository_around_an_installed_package_is_not_its_commit(monkeypatch, tmp_path):
    monkeypatch.setattr("rigid.compute.run.provenance.__file__", str(tmp_path / "provenance.py"))
    assert provenance([])["git_commit"] is None

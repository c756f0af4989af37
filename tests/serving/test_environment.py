"""A folder of a stranger's is safe to work in; programs of the user's import as they always do."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from rigid import cli
from rigid.report import canvas
from rigid.serving.child import Command
from rigid.serving.environment import for_programs, shut_working_directory
from rigid.serving.session import Promise, Session
from tests.serving.programs import write_program

LOKY = """
import os
from rigid.serving.environment import shut_working_directory

def main():
    from loky import ProcessPoolExecutor
    pool = ProcessPoolExecutor(1)
    print(pool.submit(len, "four").result())
    pool.shutdown(kill_workers=True)

if __name__ == "__main__":
    if os.environ["SHUT"] == "yes":
        shut_working_directory()
    main()
"""


@pytest.fixture
def poisoned(tmp_path, monkeypatch):
    """A working directory whose modules leave a mark when they are imported."""
    folder = tmp_path / "strangers"
    folder.mkdir()
    for name in ("cloudpickle", "mujoco"):
        (folder / f"{name}.py").write_text("open('mark', 'w').close()")
    monkeypatch.chdir(folder)
    return folder


def test_what_tries_graphics_imports_nothing_from_the_working_directory(poisoned):
    canvas._works("egl")
    assert not (poisoned / "mark").exists()


@pytest.mark.parametrize("shut", ["yes", "no"])
def test_workers_import_nothing_from_the_working_directory_of_the_command_line(
    poisoned, tmp_path, monkeypatch, shut
):
    (tmp_path / "main.py").write_text(LOKY)
    monkeypatch.setenv("SHUT", shut)
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    command = [sys.executable, str(tmp_path / "main.py")]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert (poisoned / "mark").exists() == (shut == "no")
    if shut == "yes":
        assert done.stdout == "4\n"


def test_a_program_of_the_users_may_import_its_neighbours(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONSAFEPATH", "")
    shut_working_directory()
    (tmp_path / "beside.py").write_text("")
    (tmp_path / "served.py").write_text(
        "import beside, rigid_serve\n"
        "rigid_serve.serve_policy(lambda o: o[:, :1], observation_size=2, action_size=1)\n"
    )
    write_program(tmp_path, "")  # Puts rigid_serve.py beside it.
    session = Session(Command(f"{sys.executable} -m served", tmp_path), Promise, seconds=20)
    session.close()


@pytest.mark.parametrize(("before", "inside"), [("", "rigid"), ("1", "1")])
def test_what_the_user_set_stays(before, inside):
    environment = {"PYTHONSAFEPATH": before, "HOME": "/"}
    shut_working_directory(environment)
    assert environment["PYTHONSAFEPATH"] == inside
    left = {"HOME": "/"} if inside == "rigid" else environment
    assert for_programs(environment) == left


def test_the_command_line_shuts_the_working_directory_and_the_library_does_not(monkeypatch):
    monkeypatch.setenv("PYTHONSAFEPATH", "")
    monkeypatch.setattr("sys.argv", ["rigid", "export"])
    assert cli.run() == 2
    assert os.environ["PYTHONSAFEPATH"] == ""
    with pytest.raises(SystemExit):
        cli.main()
    assert os.environ["PYTHONSAFEPATH"]

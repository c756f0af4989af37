"""The command line as a whole: help, exit codes, and one clear message for bad input."""

from __future__ import annotations

import dataclasses
import inspect
import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from rigid import cli
from rigid.cli import run
from rigid.commands.benchmarking import BenchCommand
from rigid.commands.blaming import BlameCommand
from rigid.commands.calibrating import CalibrateCommand
from rigid.commands.compare.command import CompareCommand
from rigid.commands.data import ExportCommand as ExportDataCommand
from rigid.commands.data import ImportCommand
from rigid.commands.data.looking import CheckCommand, ShowCommand
from rigid.commands.doctoring import DoctorCommand
from rigid.commands.export.command import ExportCommand
from rigid.commands.gating import GateCommand
from rigid.commands.measuring import DemoCommand, FrontierCommand, ReportCommand
from rigid.commands.pairing import PairsCommand
from rigid.commands.playing import EvaluateCommand, RecordCommand
from rigid.commands.refereeing import RefereeCommand
from rigid.commands.study.analyzing import AnalyzeCommand
from rigid.commands.study.exporting import ExportCommand as ExportStudyCommand
from rigid.commands.study.exporting import WithdrawCommand
from rigid.commands.study.piloting import PilotCommand
from rigid.commands.study.planning import NewCommand
from rigid.commands.study.planning import ShowCommand as ShowStudyCommand
from rigid.commands.study.power import PowerCommand
from rigid.commands.study.serving import ServeCommand
from rigid.commands.train.clone import CloneCommand
from rigid.commands.train.palm import PalmCommand
from rigid.commands.train.robots import CoOptimizeCommand, GleaveCommand, VanillaCommand
from rigid.commands.train.robust import RobustCommand
from rigid.commands.verifying import VerifyCommand
from rigid.errors import UserError
from rigid.files import write_atomically

COMMANDS = {
    "demo": DemoCommand,
    "frontier": FrontierCommand,
    "report": ReportCommand,
    "train co-optimize": CoOptimizeCommand,
    "train vanilla": VanillaCommand,
    "train gleave": GleaveCommand,
    "train palm": PalmCommand,
    "train robust-gt": RobustCommand,
    "train clone": CloneCommand,
    "record": RecordCommand,
    "data import": ImportCommand,
    "data show": ShowCommand,
    "data check": CheckCommand,
    "data export": ExportDataCommand,
    "evaluate": EvaluateCommand,
    "referee": RefereeCommand,
    "verify": VerifyCommand,
    "compare": CompareCommand,
    "gate": GateCommand,
    "blame": BlameCommand,
    "pairs": PairsCommand,
    "study new": NewCommand,
    "study show": ShowStudyCommand,
    "study power": PowerCommand,
    "study pilot": PilotCommand,
    "study serve": ServeCommand,
    "study withdraw": WithdrawCommand,
    "study export": ExportStudyCommand,
    "study analyze": AnalyzeCommand,
    "export": ExportCommand,
    "bench": BenchCommand,
    "doctor": DoctorCommand,
    "calibrate": CalibrateCommand,
}

POSITIONAL = {
    "directory": "PATH ",
    "directories": "[[PATH ",
    "runs": "DIR… ",
    "file": "PATH ",
    "codes": "[[STR ",
}
RENAMED = {"run_": "from", "source": "from", "map_": "map"}


@pytest.fixture
def help_of(capsys, monkeypatch):
    """What `rigid ARGUMENTS --help` prints, on a screen that is wide enough."""
    monkeypatch.setenv("COLUMNS", "200")

    def ask(*arguments):
        with pytest.raises(SystemExit) as end:
            run([*arguments, "--help"])
        assert end.value.code == 0
        return capsys.readouterr().out

    return ask


def test_help_lists_every_command_with_one_line(help_of):
    text = help_of()
    for name, command in COMMANDS.items():
        assert f"• {name.split()[0]}" in text
        if " " not in name:
            assert command.__doc__.splitlines()[0] in text
    assert "Example" not in text


def test_every_command_is_covered_here():
    assert {name.split()[0] for name in COMMANDS} == set(cli._COMMANDS)


@pytest.mark.parametrize("name", COMMANDS)
def test_help_of_a_command_begins_with_examples_of_it(name, help_of):
    text = help_of(*name.split())
    assert f"usage: rigid {name}" in text
    assert f"\n  rigid {name} " in text.partition("--help")[0]


@pytest.mark.parametrize("name", COMMANDS)
def test_help_names_every_option_with_its_default(name, help_of):
    lines = [line.strip("│| ") for line in help_of(*name.split()).splitlines()]
    for field in dataclasses.fields(COMMANDS[name]):
        dashed = f"--{RENAMED.get(field.name, field.name).replace('_', '-')} "
        option = POSITIONAL[field.name] if "Positional" in field.type else dashed
        (place,) = [i for i, line in enumerate(lines) if f"{line} ".startswith(option)]
        said = " ".join(lines[place : place + 2])  # A long name has a line of its own.
        required = field.default is dataclasses.MISSING
        values = field.default if isinstance(field.default, tuple) else (field.default,)
        default = " ".join(map(str, values))
        shown = f"(default: {default})" if default else "(default: "  # Nothing is said in words.
        assert ("(required)" if required else shown) in said


GROUPS = {name.split()[0] for name in COMMANDS if " " in name}


@pytest.mark.parametrize("width", [80, 60])
@pytest.mark.parametrize("name", ["", *sorted(GROUPS), *COMMANDS])
def test_help_fits_into_the_terminal(name, width, help_of, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(width))
    text = help_of(*name.split())
    assert max(map(len, text.splitlines())) <= width
    assert "\n\n\n" not in text


@pytest.mark.parametrize("name", COMMANDS)
def test_help_breaks_prose_at_the_width_alone_and_shows_no_empty_default(
    name, help_of, monkeypatch
):
    monkeypatch.setenv("COLUMNS", "1000")
    text = help_of(*name.split())
    said = inspect.getdoc(COMMANDS[name]).partition("\n\nExample")[0]
    for paragraph in said.split("\n\n"):
        assert f"\n{' '.join(paragraph.split())}\n" in text
    assert "(default: )" not in text


def test_an_example_over_several_lines_is_one_command(help_of, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    said = help_of("compare").replace(" \\\n      ", " ")
    assert (
        "\n  rigid compare runs/* --humans pairs/1/human pairs/2/human --csv t.csv --latex" in said
    )


@pytest.mark.parametrize("group", ["train", "data", "study"])
def test_help_of_a_group_lists_its_commands_with_what_each_does(group, help_of):
    text = " ".join(help_of(group).replace("│", " ").split())
    members = {name: kind for name, kind in COMMANDS.items() if name.startswith(f"{group} ")}
    assert len(members) > 1
    for name, command in members.items():
        does = " ".join(inspect.getdoc(command).partition("\n\n")[0].split())
        assert f"• {name.split()[1]} {does}" in text
    assert "Example" not in text


def run_script(script: str) -> subprocess.CompletedProcess[str]:
    """Python code in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=120
    )


def test_help_loads_no_numerics_and_no_models_of_files():
    """They take seconds, and a tenth of one; whoever asks for help should not wait."""
    script = (
        "import sys; from rigid.cli import run\n"
        "heavy = {'jax', 'mujoco', 'scipy', 'numpy', 'pydantic'}\n"
        "try: run(['frontier', '--help'])\n"
        "finally: print(heavy & set(sys.modules), file=sys.stderr)"
    )
    done = run_script(script)
    assert (done.returncode, done.stderr) == (0, "set()\n")


@pytest.mark.parametrize(
    "arguments", [[], ["fronteer"], ["demo", "--robot", "x"], ["frontier"], ["evaluate", "--seed"]]
)
def test_what_cannot_be_parsed_exits_with_2(arguments, capsys):
    with pytest.raises(SystemExit) as end:
        run(arguments)
    assert end.value.code == 2
    assert "rigid" in capsys.readouterr().err


@dataclasses.dataclass
class Command:
    """Fails as it is told."""

    def run(self):
        raise self.error


@pytest.fixture
def exit_of(monkeypatch, capsys):
    """Exit code and message of a command that fails with `error`."""

    def fail(error):
        monkeypatch.setattr(Command, "error", error, raising=False)
        monkeypatch.setattr(cli, "_COMMANDS", {"fail": Command, "other": ReportCommand})
        code = run(["fail"])
        captured = capsys.readouterr()
        assert captured.out == ""
        return code, captured.err

    return fail


def test_bad_input_exits_with_2_and_one_message(exit_of):
    assert exit_of(UserError("no such robot")) == (2, "rigid: no such robot\n")


def test_a_long_message_is_one_line_in_a_log_and_wrapped_on_a_terminal(exit_of, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    said = f"{'/a-long-way' * 5} is no robot: run rigid frontier --robot ROBOT --out NEW"
    assert exit_of(UserError(said))[1] == f"rigid: {said}\n"
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    first, *lines = exit_of(UserError(said))[1].splitlines()
    assert [first, *(line.removeprefix("  ") for line in lines)] == [
        "rigid:", "/a-long-way" * 5, "is no robot: run rigid frontier", "--robot ROBOT --out NEW",
    ]  # fmt: skip


def test_a_disk_that_takes_no_more_exits_with_2_and_says_that_what_was_kept_goes_on(exit_of):
    def fill() -> OSError:
        try:
            Path("/dev/full").write_bytes(b"x")
        except OSError as error:
            return error
        pytest.fail("it was not full")

    said = "a file cannot be written (No space left on device): see to the disk; what was finished"
    code, message = exit_of(fill())
    assert code == 2
    assert message.startswith(f"rigid: {said}")


def test_a_file_that_the_system_does_not_let_grow_is_named(exit_of, tmp_path):
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
    try:
        with pytest.raises(OSError, match="File too large") as caught:
            write_atomically(tmp_path / "frontier.json", bytes(2000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert list(tmp_path.iterdir()) == []
    code, message = exit_of(caught.value)
    assert code == 2
    assert f"{tmp_path / 'frontier.json'} cannot be written (File too large)" in message


def test_an_interrupted_command_exits_with_130(exit_of):
    message = "\nrigid: interrupted; the same command begins anew\n"
    assert exit_of(KeyboardInterrupt()) == (130, message)


def test_an_interrupted_command_may_say_where_to_go_on(exit_of):
    code, message = exit_of(KeyboardInterrupt("the same command goes on in runs/demo"))
    assert code == 130
    assert message.endswith("interrupted; the same command goes on in runs/demo\n")


def test_an_interrupted_process_ends_before_libraries_can_crash_at_its_exit():
    """JAX, while it still compiles on threads of its own, with a segmentation fault."""
    script = (
        "import atexit, os; from rigid import cli; atexit.register(os._exit, 11)\n"
        "cli.run = lambda: print('shown', end='') or cli.INTERRUPTED\n"
        "cli.main()"
    )
    done = run_script(script)
    assert (done.returncode, done.stdout, done.stderr) == (130, "shown", "")


def test_an_interrupted_process_leaves_no_lock_of_its_workers_for_others_to_clear_away():
    """A worker's queues may still be held by a thread that ends a moment later."""
    script = (
        "import loky.backend; from rigid import cli; lock = loky.backend.get_context().Lock()\n"
        "cli.run = lambda: cli.INTERRUPTED\n"
        "cli.main()"
    )
    done = run_script(script)
    assert (done.returncode, done.stderr) == (130, "")


def test_a_command_that_is_told_to_end_ends_as_after_ctrl_c_with_all_its_processes(tmp_path):
    """A scheduler sends SIGTERM to every process of a job."""
    asked = ["frontier", "--preset", "demo", "--out", str(tmp_path)]
    with subprocess.Popen(
        [sys.executable, "-m", "rigid", *asked], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, process_group=0,
    ) as process:  # fmt: skip
        shown = [next(line for line in process.stdout if "training steps" in line)]
        os.killpg(process.pid, signal.SIGTERM)
        shown += process.stdout.readlines()  # Until the last of the processes has ended.
    assert process.returncode == 130
    assert shown[-1] == (
        "rigid: interrupted; nothing was kept yet, so the same command begins anew\n"
    )
    assert not [line for line in shown if "Traceback" in line or "semlock" in line]


def test_a_bug_keeps_its_traceback(exit_of):
    with pytest.raises(ZeroDivisionError):
        exit_of(ZeroDivisionError())


def test_main_exits_with_the_code_of_the_command(monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("PYTHONSAFEPATH", "")  # It is set for what is started; not for other tests.
    monkeypatch.setattr(sys, "argv", ["rigid", "report", str(tmp_path)])
    with pytest.raises(SystemExit) as end:
        cli.main()
    assert end.value.code == 2
    assert "frontier.json does not exist" in capsys.readouterr().err


def test_a_command_whose_output_nobody_reads_any_more_ends_quietly():
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-m", "rigid", "--help"], stdout=writer, stderr=subprocess.PIPE,
        check=False, text=True, timeout=60,
    )  # fmt: skip
    os.close(writer)
    assert (done.returncode, done.stderr) == (141, "")

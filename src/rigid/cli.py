"""RIGID measures how robust an assistive robot is to the way people really move.

`rigid COMMAND --help` shows a command's options with their defaults and examples.
"""

from __future__ import annotations

import functools
import operator
import os
import sys
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from typing import Annotated, Any, Protocol, runtime_checkable

import tyro

from rigid.commands.benchmarking import BenchCommand
from rigid.commands.blaming import BlameCommand
from rigid.commands.calibrating import CalibrateCommand
from rigid.commands.compare.command import CompareCommand
from rigid.commands.data import DATA
from rigid.commands.doctoring import DoctorCommand
from rigid.commands.export.command import ExportCommand
from rigid.commands.gating import GateCommand
from rigid.commands.groups import Group
from rigid.commands.measuring import DemoCommand, FrontierCommand, ReportCommand
from rigid.commands.pairing import PairsCommand
from rigid.commands.parsing import printable
from rigid.commands.playing import EvaluateCommand, RecordCommand
from rigid.commands.refereeing import RefereeCommand
from rigid.commands.study import STUDY
from rigid.commands.terminal.helping import described, fitted_help, summary
from rigid.commands.terminal.wrapping import tell
from rigid.commands.train import TRAIN
from rigid.commands.verifying import VerifyCommand
from rigid.compute.threads import fix_xla_threads
from rigid.errors import UserError
from rigid.files import disk_refusal
from rigid.interrupts import give_back_semaphores, terminated_as_interrupted
from rigid.serving.environment import shut_working_directory

INTERRUPTED = 130
PIPE_CLOSED = 141
"""As a shell tells of a command that wrote to nobody: 128 + SIGPIPE."""


@runtime_checkable
class _Runs(Protocol):
    def run(self) -> int: ...


_COMMANDS: dict[str, type[_Runs] | Group] = {
    "demo": DemoCommand,
    "frontier": FrontierCommand,
    "report": ReportCommand,
    "compare": CompareCommand,
    "gate": GateCommand,
    "blame": BlameCommand,
    "pairs": PairsCommand,
    "study": STUDY,
    "export": ExportCommand,
    "bench": BenchCommand,
    "train": TRAIN,
    "record": RecordCommand,
    "data": DATA,
    "evaluate": EvaluateCommand,
    "verify": VerifyCommand,
    "referee": RefereeCommand,
    "doctor": DoctorCommand,
    "calibrate": CalibrateCommand,
}


def main() -> None:
    """Runs one command and exits: 0 done, 1 a check failed, 2 bad input, 130 interrupted."""
    shut_working_directory()
    try:
        try:
            with terminated_as_interrupted():
                code = run()
        finally:
            sys.stdout.flush()
    except BrokenPipeError:  # As of `rigid … | head`: who reads has read enough.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python flushes again.
        code = PIPE_CLOSED
    if code == INTERRUPTED:
        # JAX may still compile or compute on threads of its own, and crashes when Python takes down
        # what they use. Nothing is left to do: files are written whole, and locks were let go.
        with suppress(OSError):
            sys.stdout.flush()
            sys.stderr.flush()
        give_back_semaphores()
        os._exit(code)
    sys.exit(code)


def run(arguments: Sequence[str] | None = None) -> int:
    """Runs one command and returns its exit code."""
    fix_xla_threads()
    command = parse(sys.argv[1:] if arguments is None else arguments)
    try:
        return command.run()
    except UserError as error:
        lines = [printable(line) for line in str(error).split("\n")]
        tell("\n".join(["rigid: " + lines[0], *lines[1:]]))
        return error.exit_code
    except OSError as error:
        told = disk_refusal(error)
        if told is None:
            raise
        tell(f"rigid: {printable(told)}")
        return UserError.exit_code
    except KeyboardInterrupt as interrupt:
        how = str(interrupt) or "the same command begins anew"
        tell(f"\nrigid: interrupted; {how}")
        return INTERRUPTED


def parse(arguments: Sequence[str]) -> _Runs:
    """The command of a command line, with its options; nothing is run.

    Raises:
        SystemExit: There is no such command or option (code 2), or help was asked for (0).
    """
    config = (
        tyro.conf.OmitSubcommandPrefixes,
        tyro.conf.OmitArgPrefixes,
        tyro.conf.FlagCreatePairsOff,
    )
    given = list(arguments)
    with fitted_help(given):
        command: _Runs = tyro.cli(
            _kinds(_COMMANDS, given), args=given, prog="rigid", description=__doc__, config=config
        )
    return command


def _kinds(commands: Mapping[str, type[_Runs] | Group], named: Collection[str]) -> Any:
    """The union of some commands. tyro drops examples from a docstring, and lists what it is told.

    So a command that is named is told its whole docstring for its own help, and those of a list
    their first paragraph. The list itself is told what it is, or tyro would look for that in the
    source of Python's `typing`, which takes a fifth of the time of `rigid --help`.
    """

    def kind(name: str, command: type[_Runs] | Group) -> Any:
        if isinstance(command, Group):
            text, chosen = command.about, _kinds(command.members, named)
        else:
            text = described(command) if name in named else summary(command)
            chosen = command
        return Annotated[chosen, tyro.conf.subcommand(name, description=text)]

    kinds = (kind(name, command) for name, command in commands.items())
    union = functools.reduce(operator.or_, kinds)
    return Annotated[union, tyro.conf.arg(help="what to do")]

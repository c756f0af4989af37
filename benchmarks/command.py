"""How a study is started: its options, its places, and the exit codes of `rigid`."""

from __future__ import annotations

import inspect
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import tyro

from rigid.commands.parsing import printable
from rigid.compute.threads import fix_xla_threads
from rigid.errors import UserError
from rigid.interrupts import terminated_as_interrupted

INTERRUPTED = 130


@dataclass(frozen=True, kw_only=True)
class Study(ABC):
    """What every study can be told; a study adds its own options and says what it does."""

    out: Path | None = None
    """Raw runs; runs/STUDY by default, runs/STUDY-quick with --quick."""
    results: Path | None = None
    """Tables, figure and account; results/STUDY by default, OUT/results with --quick."""
    quick: bool = False
    """The whole road in some minutes, with budgets that say nothing."""

    @abstractmethod
    def run(self) -> None:
        """Runs the study, or what is left of it."""

    def places(self, name: str, *, runs: str | None = None) -> tuple[Path, Path]:
        """Where raw runs and results go.

        Args:
            name: Of the study.
            runs: Folder of the raw runs of a full study, below `runs/`; `name` by default.

        Example:
            >>> class Mine(Study):
            ...     def run(self) -> None:
            ...         pass
            >>> [str(place) for place in Mine().places("planted")]
            ['runs/planted', 'results/planted']
            >>> [str(place) for place in Mine(quick=True).places("planted")]
            ['runs/planted-quick', 'runs/planted-quick/results']
        """
        out = self.out or Path("runs") / (f"{name}-quick" if self.quick else runs or name)
        usual = out / "results" if self.quick else Path("results") / name
        return out, self.results or usual


def start(kind: type[Study], name: str, arguments: Sequence[str] | None = None) -> int:
    """Runs a study with the options of a command line and returns its exit code."""
    fix_xla_threads()  # Before anything trains, so that a study says the same as the commands.
    options = tyro.cli(
        kind, args=arguments, prog=f"python -m benchmarks.{name}",
        description=inspect.getdoc(kind), config=(tyro.conf.FlagCreatePairsOff,),
    )  # fmt: skip
    return exit_code(name, options.run)


def exit_code(name: str, work: Callable[[], None]) -> int:
    """Runs a study: 0 done, 2 bad input, 130 interrupted; says why in one line.

    Example:
        >>> exit_code("study", lambda: None)
        0
    """
    try:
        with terminated_as_interrupted():
            work()
    except UserError as error:
        print(f"{name}: {printable(str(error))}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print(f"\n{name}: interrupted; the same command goes on", file=sys.stderr)
        return INTERRUPTED
    return 0

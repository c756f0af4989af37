"""`python -m benchmarks.people`: thirty participants at once, and ten thousand hostile messages."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from benchmarks.command import exit_code


@dataclass(frozen=True, kw_only=True)
class Load:
    """Thirty scripted participants play at once, over loopback, against a real server.

    Reports how evenly frames come, whether any finished episode was lost, and processor time. The
    clients share the machine with the server.

    Examples:
      python -m benchmarks.people load --clients 30 --minutes 3
      python -m benchmarks.people load --kill --out results/people/load.json
    """

    clients: int = 30
    """How many play."""
    minutes: float = 3.0
    """How long."""
    kill: bool = False
    """Kill the server with signal 9 half-way, and start it again."""
    out: Path | None = None
    """File for the result (.json)."""

    def run(self) -> None:
        """Plays, prints and writes."""
        from benchmarks.people.load import measure_load

        _finish(measure_load(self.clients, 60 * self.minutes, kill=self.kill), self.out)


@dataclass(frozen=True, kw_only=True)
class Hostile:
    """Malformed and hostile messages of many kinds, while somebody else plays.

    Each must be refused and counted, none may have an effect, and the other's episodes must not
    notice.

    Examples:
      python -m benchmarks.people hostile --messages 10000
    """

    messages: int = 10_000
    """How many."""
    seed: int = 0
    """The draw comes from it."""
    out: Path | None = None
    """File for the result (.json)."""

    def run(self) -> None:
        """Attacks, prints and writes."""
        from benchmarks.people.hostile import measure_hostile

        _finish(measure_hostile(self.messages, self.seed), self.out)


def _finish(found: dict[str, Any], out: Path | None) -> None:
    """Prints what was found, keeps it where asked for, and fails where something did not hold."""
    from rigid.files import json_text, make_room, write_atomically

    text = json_text(found, indent=1)
    print(text)
    if out is not None:
        make_room(out)
        write_atomically(out, (text + "\n").encode())
    if not found["ok"]:
        raise SystemExit(1)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one of the two: 0 all held, 1 something did not, 2 bad input, 130 interrupted."""

    def kind(option: type) -> object:
        return tyro.conf.subcommand(description=inspect.getdoc(option))

    kinds = Annotated[Load, kind(Load)] | Annotated[Hostile, kind(Hostile)]
    chosen = tyro.cli(
        kinds,
        args=arguments,
        prog="python -m benchmarks.people",
        description=__doc__,
        config=(tyro.conf.FlagCreatePairsOff,),
    )
    return exit_code("people", chosen.run)


if __name__ == "__main__":
    sys.exit(main())

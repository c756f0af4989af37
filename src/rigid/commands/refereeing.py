"""`rigid referee --check`: the gates of the referee."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.naming import PairOptions
from rigid.commands.parsing import parse_seeds
from rigid.commands.terminal.stopping import goes_on
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.compute.referee.verdict import Verdict

_shown_as = tyro.conf.arg


@dataclass(frozen=True, kw_only=True)
class RefereeCommand(PairOptions):
    """Check the referee of naturalness on a task: exit 1 when the x axis fails one of its gates.

    Examples:
      rigid referee --check --robot builtin:vanilla
      rigid referee --check --robot my/robot --human my/human --out runs/check --json
    """

    check: bool = False
    """Run the gates; there is nothing else to do yet."""
    preset: str = "paper"
    """Training and episodes of the adversaries that the gates need."""
    seeds: Annotated[str | None, _shown_as(metavar="SEEDS")] = None
    """Search seeds, as 0,1,2 or 0..9; by default the preset's."""
    out: Annotated[Path | None, _shown_as(metavar="DIR")] = None
    """Keeps the adversaries and referee-check.json; an interrupted check in it goes on."""
    json: bool = False
    """Print the verdict as JSON on standard output."""

    def run(self) -> int:
        """Runs the gates and prints a table of them."""
        if not self.check:
            raise UserError("rigid referee has nothing to do: give --check")
        seeds = parse_seeds(self.seeds)
        from rigid.commands.terminal.progress import TerminalListener
        from rigid.compute.referee.gates import check_referee
        from rigid.compute.subject import Subject
        from rigid.presets import find_preset

        preset = find_preset(self.preset)
        preset = preset if seeds is None else replace(preset, seeds=seeds)
        subject = Subject(self.open_task(), self.robot, self.human, opening=self.opening())
        with (
            _place(self.out) as out,
            goes_on(out, None if self.out else lambda: False),
            TerminalListener(f"{self.robot} · gates") as listener,
        ):
            verdict = check_referee(subject, preset, out=out, listener=listener)
        print(json.dumps(verdict.describe()) if self.json else table(verdict))
        return 1 if verdict.failed else 0


@contextmanager
def _place(out: Path | None) -> Iterator[Path]:
    """Where the adversaries are kept: the user's directory, else one that does not stay."""
    if out is not None:
        yield out
        return
    with tempfile.TemporaryDirectory(prefix="rigid-referee-") as directory:
        yield Path(directory) / "run"


def table(verdict: Verdict) -> str:
    """Every gate with what was measured; the x axis first, and last what failed there."""
    data = verdict.describe()
    axis = data["axis"]
    rows = [f"  {'level':14} {'gate':36} {'measured':>9}   limit    verdict"]
    for gate in sorted(verdict.gates, key=lambda gate: gate.level != axis):
        sign = "≥" if gate.at_least else "≤"
        word = "pass" if gate.passed else "FAIL"
        number = f"{gate.measured:9.4f} {sign} {gate.limit:5.2f}"
        rows.append(f"  {gate.level:14} {gate.name:36} {number}   {word}")
    able = [level for level, fit in data["may_be_axis"].items() if fit]
    rows += ["", f"  levels that pass every gate: {', '.join(able) or 'none'}"]
    failed = ", ".join(gate.name for gate in verdict.failed)
    if failed:
        rows.append(f"  the x axis, {axis}, FAILS: {failed}; do not believe naturalness here")
    else:
        rows.append(f"  the x axis, {axis}, passes")
    return "\n".join(["", *rows])

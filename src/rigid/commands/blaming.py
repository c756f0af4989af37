"""`rigid blame`: could any robot have coped with the humans that were found?"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from rigid.commands.naming import MeasuredTaskOptions, OpeningOptions
from rigid.commands.terminal.stopping import goes_on

_shown_as = tyro.conf.arg


@dataclass(frozen=True, kw_only=True)
class BlameCommand(OpeningOptions, MeasuredTaskOptions):
    """Train fresh robots against each harmful human on the frontier: was it this robot's fault?

    About two minutes for each human on two cores; what is done is kept in DIR/blame.json.

    Examples:
      rigid blame runs/vanilla
      rigid blame runs/vanilla --points s0-r1-l5,s0-r2-l4 --json
    """

    directory: Annotated[Path, tyro.conf.Positional]
    """A finished run directory."""
    robot: Annotated[str | None, _shown_as(metavar="ROBOT")] = None
    """The measured robot, if it is no longer where it was."""
    points: Annotated[str | None, _shown_as(metavar="IDS")] = None
    """Points to look at, as s0-r1-l5,s0-r2-l4; by default all that are harmful on the frontier."""
    json: bool = False
    """Print blame.json on standard output."""

    def run(self) -> int:
        """Trains the responses and prints what they say."""
        from rigid.commands.terminal.progress import TerminalListener
        from rigid.compute.blame import FILE, blame

        file = self.directory / FILE
        names = None if self.points is None else [part.strip() for part in self.points.split(",")]
        with goes_on(file, file.exists), TerminalListener("best responses") as listener:
            found = blame(
                self.directory, task=self.named_task(), robot=self.robot, opening=self.opening(),
                points=names, say=listener.say, expect=listener.expect, advance=listener.advance,
            )  # fmt: skip
        print(json.dumps(found, indent=1) if self.json else table(found))
        return 0


def table(found: Mapping[str, Mapping[str, Any]]) -> str:
    """One line for each human, the worst regret first."""
    if not found:
        return "no point on the frontier does harm: nothing to blame"
    lines = [f"{'point':12}  {'robot':>6}  {'best':>6}  {'regret':>6}  {'success':>14}  verdict"]
    for name, entry in sorted(found.items(), key=lambda item: -item[1]["regret"]):
        mine = entry["robot"]["adversarialness"]
        success = f"{_share(entry['robot']['success'])} → {_share(entry['solvable'])}"
        lines.append(
            f"{name:12}  {mine:6.3f}  {mine - entry['regret']:6.3f}  {entry['regret']:6.3f}  "
            f"{success:>14}  {entry['verdict']}"
        )
    lines.append("adversarialness with this robot, with the best response, and the difference")
    return "\n".join(lines)


def _share(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f}"

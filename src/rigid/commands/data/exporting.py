"""`rigid data export`: canonical episodes for other programs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro

_shown_as = tyro.conf.arg


@dataclass(frozen=True, kw_only=True)
class ExportCommand:
    """Write episodes as a Minari dataset of one agent, or as a CSV table.

    Consent, licence and task go along. The robot's view needs --robot, which plays the episodes
    again; the human's view then gains the last observation and every reward.

    Examples:
      rigid data export canonical.npz --to minari --agent human --out people-v0
      rigid data export canonical.npz --to csv --out people.csv
    """

    file: Annotated[Path, tyro.conf.Positional]
    """File of episodes (.npz)."""
    out: Annotated[str, _shown_as(metavar="PATH|minari:ID")]
    """New directory, named as Minari wants (NAME-v0), or minari:ID; for CSV a new file."""
    to: Literal["minari", "csv"] = "minari"
    """Format."""
    agent: Literal["human", "robot"] = "human"
    """Whose view (Minari)."""
    robot: Annotated[str | None, _shown_as(metavar="ROBOT")] = None
    """The robot that the human met, to play the episodes again."""
    task: Annotated[str | None, _shown_as(metavar="TASK")] = None
    """Their task, where RIGID does not know it by its name."""
    trust: bool = False
    """Open a robot whose file can run code: only from people you trust."""

    def run(self) -> int:
        """Reads and writes."""
        from rigid.commands.data.views import export
        from rigid.commands.terminal.progress import TerminalListener

        with TerminalListener(f"exporting {self.file}"):
            said = export(self)
        print(said)
        return 0

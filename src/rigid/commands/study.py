"""`rigid study`: people in the loop."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import Annotated

import tyro

from rigid.commands.study_analyzing import AnalyzeCommand
from rigid.commands.study_exporting import ExportCommand, WithdrawCommand
from rigid.commands.study_piloting import PilotCommand
from rigid.commands.study_planning import NewCommand, ShowCommand
from rigid.commands.study_power import PowerCommand
from rigid.commands.study_serving import ServeCommand


@dataclass(frozen=True)
class StudyCommand:
    """People in the loop: they play against the robot, and judge motions."""

    what: (
        Annotated[NewCommand, tyro.conf.subcommand("new", description=inspect.getdoc(NewCommand))]
        | Annotated[
            ShowCommand, tyro.conf.subcommand("show", description=inspect.getdoc(ShowCommand))
        ]
        | Annotated[
            PowerCommand, tyro.conf.subcommand("power", description=inspect.getdoc(PowerCommand))
        ]
        | Annotated[
            PilotCommand, tyro.conf.subcommand("pilot", description=inspect.getdoc(PilotCommand))
        ]
        | Annotated[
            ServeCommand, tyro.conf.subcommand("serve", description=inspect.getdoc(ServeCommand))
        ]
        | Annotated[
            WithdrawCommand,
            tyro.conf.subcommand("withdraw", description=inspect.getdoc(WithdrawCommand)),
        ]
        | Annotated[
            ExportCommand, tyro.conf.subcommand("export", description=inspect.getdoc(ExportCommand))
        ]
        | Annotated[
            AnalyzeCommand,
            tyro.conf.subcommand("analyze", description=inspect.getdoc(AnalyzeCommand)),
        ]
    )
    """What to do."""

    def run(self) -> int:
        """Runs the chosen command."""
        return self.what.run()

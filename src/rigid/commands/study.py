"""`rigid study`: people in the loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from rigid.commands.groups import member
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
        Annotated[NewCommand, member("new", NewCommand)]
        | Annotated[ShowCommand, member("show", ShowCommand)]
        | Annotated[PowerCommand, member("power", PowerCommand)]
        | Annotated[PilotCommand, member("pilot", PilotCommand)]
        | Annotated[ServeCommand, member("serve", ServeCommand)]
        | Annotated[WithdrawCommand, member("withdraw", WithdrawCommand)]
        | Annotated[ExportCommand, member("export", ExportCommand)]
        | Annotated[AnalyzeCommand, member("analyze", AnalyzeCommand)]
    )
    """What to do."""

    def run(self) -> int:
        """Runs the chosen command."""
        return self.what.run()

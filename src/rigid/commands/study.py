"""`rigid study`: people in the loop."""

from __future__ import annotations

from rigid.commands.groups import Group
from rigid.commands.study_analyzing import AnalyzeCommand
from rigid.commands.study_exporting import ExportCommand, WithdrawCommand
from rigid.commands.study_piloting import PilotCommand
from rigid.commands.study_planning import NewCommand, ShowCommand
from rigid.commands.study_power import PowerCommand
from rigid.commands.study_serving import ServeCommand

STUDY = Group(
    "People in the loop: they play against the robot, and judge motions.",
    {
        "new": NewCommand,
        "show": ShowCommand,
        "power": PowerCommand,
        "pilot": PilotCommand,
        "serve": ServeCommand,
        "withdraw": WithdrawCommand,
        "export": ExportCommand,
        "analyze": AnalyzeCommand,
    },
)

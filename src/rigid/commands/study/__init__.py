"""`rigid study`: people in the loop."""

from __future__ import annotations

from rigid.commands.groups import Group
from rigid.commands.study.analyzing import AnalyzeCommand
from rigid.commands.study.exporting import ExportCommand, WithdrawCommand
from rigid.commands.study.piloting import PilotCommand
from rigid.commands.study.planning import NewCommand, ShowCommand
from rigid.commands.study.power import PowerCommand
from rigid.commands.study.serving import ServeCommand

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

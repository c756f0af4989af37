"""`rigid data`: canonical episodes from people's recordings, and back."""

from __future__ import annotations

from rigid.commands.data.exporting import ExportCommand
from rigid.commands.data.importing import ImportCommand
from rigid.commands.data.looking import CheckCommand, ShowCommand
from rigid.commands.groups import Group

DATA = Group(
    "Canonical episodes from people: import, look at, check, export.",
    {
        "import": ImportCommand,
        "show": ShowCommand,
        "check": CheckCommand,
        "export": ExportCommand,
    },
)

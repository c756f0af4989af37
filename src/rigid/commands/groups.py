"""Commands that are groups of others, such as `rigid study`."""

from __future__ import annotations

from typing import Any

import tyro

from rigid.commands.helping import described


def member(name: str, command: type) -> Any:
    """How a command is called within its group; its help is its whole docstring.

    Args:
        name: On the command line.
        command: Annotated with what this returns.
    """
    return tyro.conf.subcommand(name, description=described(command))

"""Commands that are groups of others, such as `rigid study`."""

from __future__ import annotations

import inspect
from typing import Any

import tyro


def member(name: str, command: type) -> Any:
    """How a command is called within its group; its help is its whole docstring.

    Args:
        name: On the command line.
        command: Annotated with what this returns.
    """
    return tyro.conf.subcommand(name, description=inspect.getdoc(command))

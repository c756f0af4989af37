"""Commands that are groups of others, such as `rigid study`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Group:
    """A choice of commands."""

    about: str
    """What they have in common, for its help."""
    members: Mapping[str, type]
    """By what they are called, in the order in which help lists them."""

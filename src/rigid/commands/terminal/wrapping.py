"""Text for people in lines that their terminal shows whole: broken between words, never in one."""

from __future__ import annotations

import os
import re
import sys
import textwrap
from contextlib import suppress

UNKNOWN = 80
"""Columns where there is no terminal that could say: what terminals open with."""
_LEAST = 40
_HELD = re.compile(
    r"(?<=[≥≤:=]) (?=[-+]?\d)|(?<=\d) (?=%)|(?<=\bat) (?=\d)|(?<=\d,) (?=[-+]?[\d.]+\])"
)
"""Spaces that become such: `≥ 0.9`, `95 %`, `[0.8, 1]`."""
NO_BREAK = "\N{NO-BREAK SPACE}"
"""In a text that is wrapped: a space at which no line ends."""


def columns(*, of_errors: bool = False) -> int:
    """How wide the terminal is: COLUMNS, what it says itself, or 80 where none is; at least 40.

    Args:
        of_errors: The one of standard error, not of standard output.
    """
    stream = sys.stderr if of_errors else sys.stdout
    found = 0
    with suppress(KeyError, ValueError):
        found = int(os.environ["COLUMNS"])
    if found <= 0:
        with suppress(OSError, ValueError, AttributeError):  # A file, a pipe, or a test's capture.
            found = os.get_terminal_size(stream.fileno()).columns
    return max(found or UNKNOWN, _LEAST)


def wrapped(text: str, width: int, *, hanging: str = "  ") -> str:
    """Text in lines of at most `width`, but for a word that is longer; numbers keep their signs.

    Args:
        text: Its own line breaks stay.
        width: Of the terminal, in columns.
        hanging: What each further line of a line begins with.

    Example:
        >>> print(wrapped("of 95 % intervals, look in runs/a-robot-of-mine", 20))
        of 95 % intervals,
          look in
          runs/a-robot-of-mine
    """
    lines = (
        textwrap.fill(
            _HELD.sub(NO_BREAK, line), width, subsequent_indent=hanging, break_long_words=False,
            break_on_hyphens=False,
        )
        if len(line) > width else line
        for line in text.split("\n")
    )  # fmt: skip
    return "\n".join(lines).replace(NO_BREAK, " ")


def show(text: str) -> None:
    """Prints a result: wrapped for a terminal, in a pipe one line, as programs read it."""
    print(wrapped(text, columns()) if sys.stdout.isatty() else text)


def tell(text: str) -> None:
    """Says something on standard error: wrapped for a terminal, in a log as it is.

    There a message is one line, so that it can be searched for.
    """
    shown = wrapped(text, columns(of_errors=True)) if sys.stderr.isatty() else text
    print(shown, file=sys.stderr, flush=True)

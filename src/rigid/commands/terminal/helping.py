"""The help of commands: tyro's, with its prose and examples in the width of the terminal.

tyro wraps what stands in boxes. Prose above them it leaves as long as it is, breaks before a digit,
and parts paragraphs by two empty lines where one begins with a digit.
"""

from __future__ import annotations

import inspect
import io
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from typing import Any

import tyro

from rigid.commands.terminal.wrapping import NO_BREAK, columns, wrapped

_ASKED = {"-h", "--help"}
_BOX = tuple("│|╭╰+\x1b")
"""What lines that tyro has fitted begin with; colours begin with an escape."""
_ANSI = re.compile(r"\x1b\[[\d;]*m")
_TOGETHER = re.compile(r"(?<= )(--[\w-]+) (?!-)")
_QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"")


def described(command: type) -> str:
    """A command's docstring for tyro: each paragraph in one line, examples as they are."""
    paragraphs = (inspect.getdoc(command) or "").split("\n\n")
    return "\n\n".join(re.sub(r"\n(?! )", " ", paragraph) for paragraph in paragraphs)


def summary(command: type) -> str:
    """The first paragraph of that: what a list of commands has room for."""
    return described(command).partition("\n\n")[0]


def several(metavar: str | None = None) -> Any:
    """How an option of any number of values is annotated that has none by default.

    tyro would show "(default: )".

    Args:
        metavar: What stands for the values.
    """
    return tyro.conf.arg(metavar=metavar, help_behavior_hint="(default: None)")


@contextmanager
def fitted_help(arguments: Sequence[str]) -> Iterator[None]:
    """Fits the help that is printed meanwhile into the terminal, where the arguments ask for it."""
    if not _ASKED & set(arguments):
        yield
        return
    page = _Page()
    try:
        with redirect_stdout(page):
            yield
    finally:
        print(fitted(page.getvalue(), columns()), end="")


def fitted(page: str, width: int) -> str:
    """A page of help in lines of at most `width`, but for words that are longer.

    Args:
        page: As tyro prints it for a terminal of that width.
        width: Of the terminal, in columns.
    """
    return "\n".join(_line(line, width) for line in re.sub(r"\n{3,}", "\n\n", page).split("\n"))


def _line(line: str, width: int) -> str:
    plain = _ANSI.sub("", line)
    if len(plain) <= width:
        return line
    if plain.startswith("usage: "):
        broken = wrapped(plain.replace(",", ", "), width, hanging=" " * len("usage: "))
        return re.sub(r", (?=\S)", ",", broken).replace(", \n", ",\n")
    if line.startswith(_BOX):
        return line
    return _command(line, width) if line.startswith("  ") else wrapped(line, width, hanging="")


def _command(line: str, width: int) -> str:
    r"""An example over several lines, which a shell reads as one.

    Example:
        >>> print(_command("  rigid gate runs/mine --max-worst 0.4", 30))
          rigid gate runs/mine \
              --max-worst 0.4
    """
    held = _TOGETHER.sub(rf"\1{NO_BREAK}", line)
    held = _QUOTED.sub(lambda found: found[0].replace(" ", NO_BREAK), held)
    return wrapped(held, width - len(" \\"), hanging=" " * 6).replace("\n", " \\\n")


class _Page(io.StringIO):
    """Takes what is printed, and answers as the screen does: tyro asks for colours and boxes."""

    def __init__(self) -> None:
        super().__init__()
        self._screen = sys.stdout

    @property
    def encoding(self) -> str:  # type: ignore[override]  # A variable in typeshed; here it follows the screen.
        """The screen's."""
        return self._screen.encoding

    def isatty(self) -> bool:
        """Whether the screen is a terminal."""
        return self._screen.isatty()

"""A page for each command, from what `rigid COMMAND --help` prints: it cannot differ from it."""

from __future__ import annotations

import contextlib
import io
import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from rigid.cli import run

_WIDE = "1000"
"""Columns of the terminal that the help is printed for: no text of it is broken into lines."""
_EXIT_CODES = (
    "Exit codes: 0 done; 1 a check failed (`verify`, `referee --check`, `doctor`); 2 bad input, in "
    "one message; 3 `rigid gate` failed; 130 interrupted, and told "
    "whether the same command goes on or begins anew."
)
_BOXES = {"positional arguments": "arguments", "options": "options"}


class Option(NamedTuple):
    """A row of a command's table."""

    name: str
    meaning: str
    default: str
    """Empty where there is none, `required` where it has to be given."""


class Help(NamedTuple):
    """What a command says of itself."""

    name: str
    """As it is typed behind `rigid`, `train vanilla`; empty for `rigid` itself."""
    usage: str
    paragraphs: tuple[str, ...]
    examples: tuple[str, ...]
    options: tuple[Option, ...]
    commands: tuple[str, ...]
    """Names of the commands below it."""


def setup(app: Any) -> dict[str, Any]:
    """Writes the pages before Sphinx looks which there are."""
    app.connect("config-inited", lambda app, _: write_pages(Path(app.confdir) / "commands"))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def every_command() -> Iterator[Help]:
    """Every command that does something, those of `rigid train` among them."""
    waiting = [*help_of("").commands]
    while waiting:
        found = help_of(waiting.pop(0))
        waiting[:0] = [f"{found.name} {name}" for name in found.commands]
        if not found.commands:
            yield found


def help_of(name: str) -> Help:
    """What `rigid NAME --help` says."""
    return read_help(name, _printed([*name.split(), "--help"]))


def _printed(arguments: Sequence[str]) -> str:
    # Boxes are drawn around options where the terminal knows such signs.
    out, before = io.TextIOWrapper(io.BytesIO(), "utf-8"), os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = _WIDE
    try:
        with contextlib.redirect_stdout(out), contextlib.suppress(SystemExit):
            run(arguments)
    finally:
        os.environ.pop("COLUMNS") if before is None else os.environ.update(COLUMNS=before)
    out.seek(0)
    return out.read()


def read_help(name: str, text: str) -> Help:
    """The parts of a help text.

    Args:
        name: The command.
        text: As printed for a terminal so wide that no line of it is broken.
    """
    above, *boxes = re.split(r"^╭─ (?=[a-z ]+ ─)", text, flags=re.MULTILINE)
    usage, _, prose = above.partition("\n")
    prose, _, examples = re.sub(r"^Examples?:$", "\0", prose, flags=re.MULTILINE).partition("\0")
    options: list[Option] = []
    commands: list[str] = []
    for box in boxes:
        title, lines = box.partition(" ─")[0], [line[2:-2] for line in box.splitlines()[1:-1]]
        if title in _BOXES:
            options += _rows(lines)
        else:
            commands += [line.split()[1] for line in lines if line.lstrip().startswith("• ")]
    return Help(
        name=name,
        usage=usage.removeprefix("usage: "),
        paragraphs=tuple(" ".join(part.split()) for part in prose.strip().split("\n\n")),
        examples=tuple(line.strip() for line in examples.splitlines() if line.strip()),
        options=tuple(options),
        commands=tuple(commands),
    )


def _rows(lines: Sequence[str]) -> Iterator[Option]:
    """Options of a box; a name that is too long for its column has a line of its own."""
    entries: list[str] = []
    for line in lines:
        if line.startswith(" ") and entries:
            entries[-1] += "  " + line.strip()
        else:
            entries.append(line.strip())
    for entry in entries:
        name, _, meaning = entry.partition("  ")
        found = re.fullmatch(r"(.*?) ?\((required|default: (.*))\)", meaning.strip())
        if found is None:  # --help itself.
            continue
        default = "required" if found[2] == "required" else found[3]
        yield Option(name, found[1], "" if default in {"None", "False"} else default)


def page(command: Help) -> str:
    """The page of a command, in Markdown."""
    lines = [f"# rigid {command.name}", "", *_spaced(map(escaped, command.paragraphs))]
    if command.examples:
        lines += ["```bash", *command.examples, "```", ""]
    lines += ["## Options", "", "```text", command.usage, "```", ""]
    lines += ["| option | meaning | default |", "|---|---|---|"]
    for option in command.options:
        default = {"": "", "required": "**required**"}.get(option.default, f"`{option.default}`")
        name = option.name.replace("|", r"\|")  # A table's cells end there, code or not.
        lines.append(f"| `{name}` | {escaped(option.meaning)} | {default} |")
    return "\n".join(lines) + "\n"


def _spaced(paragraphs: Iterator[str]) -> Iterator[str]:
    for paragraph in paragraphs:
        yield from (paragraph, "")


def escaped(text: str) -> str:
    r"""Plain text as Markdown, but for what stands between backticks.

    Example:
        >>> print(escaped("a_b of `c_d` | *"))
        a\_b of `c_d` \| \*
    """
    parts = text.split("`")
    parts[::2] = [re.sub(r"([\\*_|<>\[\]])", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)


def index(commands: Sequence[Help]) -> str:
    """The page that lists them."""
    rows = [
        f"| [`rigid {command.name}`]({_file(command.name)}) | {escaped(command.paragraphs[0])} |"
        for command in commands
    ]
    names = [_file(command.name).removesuffix(".md") for command in commands]
    return "\n".join([
        "# Commands", "",
        "What `rigid COMMAND --help` prints; these pages are made from it.", "",
        "| command | does |", "|---|---|", *rows, "",
        _EXIT_CODES, "",
        "```{toctree}", ":hidden:", "", *names, "```", "",
    ])  # fmt: skip


def _file(name: str) -> str:
    return f"{name.replace(' ', '-')}.md"


def write_pages(folder: Path) -> None:
    """Writes the pages of all commands, and removes those of commands that are gone."""
    folder.mkdir(parents=True, exist_ok=True)
    commands = list(every_command())
    pages = {_file(command.name): page(command) for command in commands}
    pages["index.md"] = index(commands)
    for path in folder.glob("*.md"):
        if path.name not in pages:
            path.unlink()
    for name, text in pages.items():
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:  # Sphinx asks for times.
            path.write_text(text, encoding="utf-8")

"""The code blocks of the documentation, and how they are run.

A block is shell, which has the language bash or none and then a command in it, or Python. Shell
blocks of a page run in order in one directory; each Python block runs there in a process of its
own, or is stored where it begins with the name of a file. Runs are small: `tests/docs/small.py`
says how. A block below `<!-- not run: REASON -->` does not run; of it, as of every other, each
`rigid` command is parsed.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from markdown_it import MarkdownIt

ROOT = Path(__file__).parents[2]
_PROGRAMS = ("rigid", "make", "python", "pip", "ray", ".venv/bin", "git", "source", "cd", "python3")
_MARK = re.compile(r"<!-- not run: (.+?) -->")
_PATTERN = re.compile(r"\b[A-Z]{3,}\b(?![.=-])")


class Block(NamedTuple):
    """One fenced block."""

    page: str
    line: int
    language: str
    """`bash`, `python`, or empty for what is no code."""
    text: str
    reason: str | None
    """Why it does not run; None where it does."""

    @property
    def file(self) -> str | None:
        """The file that a Python block is, as its first line says: `# my_task.py`."""
        named = re.match(r"# (\w+\.py)\b", self.text) if self.language == "python" else None
        return named and named[1]

    @property
    def commands(self) -> list[str]:
        """Shell commands, each on one line, without comments."""
        joined = re.sub(r"\\\n\s*", "", self.text)
        stripped = (re.sub(r"(^|\s+)#.*$", "", line).strip() for line in joined.splitlines())
        return [line for line in stripped if line]


def pages() -> list[Path]:
    """Every page with code that a reader may copy."""
    guides = ROOT.glob("docs/*.md"), ROOT.glob("docs/api/*.md"), ROOT.glob("examples/ci/*.md")
    return [ROOT / "README.md", *sorted(page for found in guides for page in found)]


def blocks_of(page: Path) -> list[Block]:
    """The blocks of a page, in order."""
    name, found, reason = page.relative_to(ROOT).as_posix(), [], None
    for token in MarkdownIt().parse(page.read_text(encoding="utf-8")):
        if token.type == "fence":
            language = _language(token.info.strip(), token.content)
            found.append(Block(name, token.map[0] + 1, language, token.content, reason))
        if token.level == 0:
            mark = _MARK.search(token.content) if token.type == "html_block" else None
            reason = mark and mark[1]
    return found


def _language(info: str, text: str) -> str:
    if info in {"bash", "sh", "python"}:
        return "bash" if info == "sh" else info
    commands = any(line.lstrip().startswith(_PROGRAMS) for line in text.splitlines())
    return "bash" if not info and commands else ""


def expanded(block: Block) -> list[str]:
    """The commands of a block, with the variables that it sets itself."""
    values = dict(re.findall(r'^([A-Z]+)="(.*)"$', block.text, re.MULTILINE))
    return [
        re.sub(r"\$([A-Z]+)", lambda name: values.get(name[1], name[0]), command)
        for command in block.commands
    ]


def rigid_calls(command: str) -> Iterator[list[str]]:
    """The arguments of each `rigid` in a shell command."""
    lexer = shlex.shlex(command, posix=True, punctuation_chars=True)
    lexer.whitespace_split = True
    words: list[str] = []
    for word in [*lexer, ";"]:
        if set(word) <= set("();<>|&"):
            if words and Path(words[0]).name == "rigid":
                yield words[1:]
            words = []
        else:
            words.append(word)


def is_pattern(command: str) -> bool:
    """Whether capitals stand for what a reader has to fill in, as in ray:HOST:PORT."""
    return bool(_PATTERN.search(re.sub(r"\$\w+|\"[^\"]*\"", "", command)))

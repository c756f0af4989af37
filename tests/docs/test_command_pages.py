"""The pages of commands say what `rigid COMMAND --help` says."""

from __future__ import annotations

import dataclasses

import pytest
from extensions.command_pages import Option, every_command, page, read_help, write_pages
from markdown_it import MarkdownIt

from rigid import cli
from tests.test_cli import COMMANDS, POSITIONAL, RENAMED


@pytest.fixture(scope="module")
def commands():
    return {command.name: command for command in every_command()}


def test_every_command_has_a_page(commands):
    assert {name.split()[0] for name in commands} == set(cli._COMMANDS)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_page_names_every_option_with_its_default_and_every_example(name, commands):
    kind, found = COMMANDS[name], commands[name]
    shown = {option.name.split()[0].strip("[").lstrip("-"): option for option in found.options}
    for field in dataclasses.fields(kind):
        label = RENAMED.get(field.name, field.name).replace("_", "-")
        if "Positional" in field.type:
            label = POSITIONAL[field.name].split()[0].strip("[")
        default = field.default if isinstance(field.default, tuple) else (field.default,)
        said = {(None,): "", (dataclasses.MISSING,): "required"}.get(default)
        if said is None:
            said = (
                "" if default == (False,) and field.type == "bool" else " ".join(map(str, default))
            )
        assert shown[label].default == said or default == ("",)  # An empty text is shown in words.
    assert len(shown) == len(dataclasses.fields(kind))
    assert all(line in kind.__doc__ for line in found.examples)
    assert found.examples


HELP = """\
usage: rigid try [-h] [TRY OPTIONS]

Try it.

More of it, in
two lines.

Example:
  rigid try --a_b 3

╭─ options ───────────────────────────────╮
│ -h, --help  show this help message      │
│ --a INT     What | it is. (default: 3)  │
│ --a-name-that-is-long FILE              │
│             Where. (required)           │
╰─────────────────────────────────────────╯
"""


def test_a_help_text_is_read_in_parts():
    found = read_help("try", HELP)
    assert found.paragraphs == ("Try it.", "More of it, in two lines.")
    assert found.examples == ("rigid try --a_b 3",)
    assert found.options == (
        Option("--a INT", "What | it is.", "3"),
        Option("--a-name-that-is-long FILE", "Where.", "required"),
    )


def test_signs_of_markdown_in_a_help_text_stay_signs():
    html = MarkdownIt().enable("table").render(page(read_help("try", HELP)))
    assert "<td>What | it is.</td>" in html


def test_pages_of_commands_that_are_gone_are_removed(tmp_path):
    (tmp_path / "gone.md").touch()
    write_pages(tmp_path)
    assert not (tmp_path / "gone.md").exists()
    assert (tmp_path / "train-vanilla.md").exists()
    assert "(train-vanilla.md)" in (tmp_path / "index.md").read_text()

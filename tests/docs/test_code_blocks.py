"""What the documentation tells people to type works."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import Counter

import pytest

from rigid import cli
from rigid.data.column_map import load_map
from tests.docs.blocks import ROOT, Block, blocks_of, expanded, is_pattern, pages, rigid_calls

BLOCKS = [block for page in pages() for block in blocks_of(page)]
SHELL = [block for block in BLOCKS if block.language == "bash"]
MAKE_TARGETS = set(re.findall(r"^([a-z-]+):.*## ", (ROOT / "Makefile").read_text(), re.MULTILINE))

NOT_SMALL = {
    "rigid train robust-gt": "runs of two iterations may hold no human of naturalness 0.2 to 0.8",
    "rigid blame": "trains fresh robots, minutes for each human",
    "rigid pairs": "runs of two iterations hold no pairs",
    "rigid referee": "trains adversaries of a real budget",
    "rigid verify": "trains adversaries of a real budget",
    "rigid bench": "times real work",
}
"""Commands of running blocks that are only parsed, and why."""

NOT_RUN = {
    "README.md": 2,
    "docs/exec.md": 1,
    "docs/gallery.md": 1,
    "docs/new-domain.md": 3,
    "docs/policies.md": 5,
    "docs/scaling.md": 2,
    "docs/study.md": 2,
    "docs/tasks.md": 4,
    "docs/tutorial.md": 3,
}
"""How many blocks of each page are marked as not run: a new one has to be counted here."""


def named(block: Block) -> str:
    return f"{block.page}:{block.line}"


def test_blocks_that_do_not_run_are_counted_and_say_why():
    marked = [block for block in BLOCKS if block.reason is not None]
    assert dict(Counter(block.page for block in marked)) == NOT_RUN
    assert all(len(block.reason.split()) >= 3 for block in marked)


@pytest.mark.parametrize("block", SHELL, ids=named)
def test_every_command_line_is_one_that_rigid_takes(block, capsys):
    for command in expanded(block):
        for arguments in rigid_calls(command):
            try:
                cli.parse(arguments)
            except SystemExit:
                pytest.fail(
                    f"{named(block)}: rigid {' '.join(arguments)}\n{capsys.readouterr().err}"
                )


def test_the_map_of_columns_that_is_shown_is_one_that_rigid_takes(tmp_path):
    page = (ROOT / "docs" / "canonical-data.md").read_text(encoding="utf-8")
    (shown,) = re.findall(r"```json\n(.*?)```", page, re.DOTALL)
    path = tmp_path / "map.json"
    path.write_text(shown)
    assert load_map(path)["time"].factor == 1e-3


@pytest.mark.parametrize("block", SHELL, ids=named)
def test_every_make_target_exists(block):
    targets = {
        word
        for command in block.commands
        if command.startswith("make ")
        for word in command.split()[1:]
        if "=" not in word
    }
    assert targets <= MAKE_TARGETS


def run_by(command: str) -> bool:
    """Whether a command of a running block is run: `make` and patterns are not, nor `NOT_SMALL`."""
    unfit = command.startswith(("make ", *NOT_SMALL)) or is_pattern(command)
    return not unfit


def script_of(block: Block) -> str:
    """A shell block as a script; a gate may shut, since small runs say nothing."""
    lines = [command for command in block.commands if run_by(command)]
    gated = [re.sub(r"^(rigid gate [^|&;]*)$", r"\1 || [ $? = 3 ]", line) for line in lines]
    return "\n".join(["set -euo pipefail", *gated])


PYTHON_PAGES, SHELL_PAGES = [], []
for _page in pages():
    _running = [b for b in blocks_of(_page) if b.language and b.reason is None]
    if any(b.language == "bash" and script_of(b).count("\n") for b in _running):
        SHELL_PAGES.append(_page)
    elif _running:
        PYTHON_PAGES.append(_page)


BLOCK_SECONDS = 900.0
"""Until a block counts as hung; a shared machine may be slow."""


def run_page(page, place):
    """Runs the blocks of a page, in order, in `place`."""
    tools = place / "bin"
    tools.mkdir()
    for name, words in (("rigid", "-m tests.docs.small"), ("python", ""), ("python3.7", "")):
        path = tools / name
        path.write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n')
        path.chmod(0o755)
    environment = {
        **os.environ,
        "PATH": f"{tools}:{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0",
    }
    for block in blocks_of(page):
        if block.file is not None:
            (place / block.file).write_text(block.text)
    for block in blocks_of(page):
        if block.reason is not None or not block.language or block.file is not None:
            continue
        if block.language == "python":
            small = "from tests.docs.small import shrink_presets as _shrink; _shrink()\n"
            needs = "measure(" in block.text  # Others need not wait for what it imports.
            words = [sys.executable, "-c", (small if needs else "") + block.text]
        else:
            words = ["bash", "-c", script_of(block)]
        done = subprocess.run(
            words, cwd=place, env=environment, capture_output=True, text=True, check=False,
            timeout=BLOCK_SECONDS,
        )  # fmt: skip
        assert done.returncode == 0, (
            f"{named(block)} failed; mend it, or write <!-- not run: REASON --> above it and count "
            f"it in NOT_RUN\n{block.text}\n{done.stdout}\n{done.stderr}"
        )


@pytest.mark.parametrize("page", PYTHON_PAGES, ids=lambda page: page.name)
def test_the_python_of_a_page_runs(page, tmp_path, stage):
    stage(page.relative_to(ROOT).as_posix(), tmp_path)
    run_page(page, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("page", SHELL_PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_the_commands_of_a_page_run(page, tmp_path, stage):
    stage(page.relative_to(ROOT).as_posix(), tmp_path)
    run_page(page, tmp_path)

"""Every page is where a reader finds it, and every public name has its documentation."""

from __future__ import annotations

import importlib
import re

import pytest

from tests.docs.blocks import ROOT

INDEX = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
TREES = re.findall(r"```\{toctree\}\n(.*?)```", INDEX, re.DOTALL)
ENTRIES = re.findall(r"^(?:.* <)?([\w./-]+?)>?$", "\n".join(TREES), re.MULTILINE)
PAGES = {
    path.relative_to(ROOT).with_suffix("").as_posix()
    for pattern in ("docs/*.md", "examples/*/README.md", "results/**/README.md")
    for path in ROOT.glob(pattern)
}
API = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs" / "api").glob("*.md"))
PUBLIC_NAMES = importlib.import_module("rigid").__all__


def test_every_page_is_in_the_navigation_of_docs_index():
    placed = {(ROOT / "docs" / entry).resolve().relative_to(ROOT).as_posix() for entry in ENTRIES}
    assert sorted(PAGES - placed - {"docs/index"}) == []


def test_the_navigation_names_no_page_that_is_gone():
    made = {"commands/index"}
    assert [e for e in ENTRIES if e not in made and not (ROOT / "docs" / f"{e}.md").exists()] == []


@pytest.mark.parametrize("name", PUBLIC_NAMES)
def test_every_public_name_is_in_the_reference(name):
    assert re.search(
        rf"^\.\. (autofunction|autoclass|autoexception|data):: rigid\.{name}$", API, re.MULTILINE
    )

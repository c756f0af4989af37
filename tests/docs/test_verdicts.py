"""The table of verdicts on imported episodes says everything that RIGID may say of one."""

from __future__ import annotations

import ast
import inspect
import re

from rigid.data import judging
from tests.docs.blocks import ROOT

PAGE = (ROOT / "docs" / "canonical-data.md").read_text(encoding="utf-8")


def said_in(module):
    """How the messages begin that a module fills in."""
    tree = ast.parse(inspect.getsource(module))
    filled = [node.values[0] for node in ast.walk(tree) if isinstance(node, ast.JoinedStr)]
    texts = [part.value for part in filled if isinstance(part, ast.Constant)]
    return {text for text in texts if re.match(r"[a-z]{3}", text)}


def test_every_verdict_stands_in_the_table():
    table = PAGE.partition("| verdict | when |")[2].partition("\n\n")[0]
    cells = [row.split("|")[1] for row in table.splitlines() if row.startswith("| ")]
    # What follows an ellipsis or stands in parentheses is not how the message begins.
    names = [re.split("…|[(]", name)[0].strip() for cell in cells for name in cell.split(",")]
    assert "good" in names
    unnamed = [text for text in said_in(judging) if not text.startswith(tuple(names))]
    assert unnamed == []

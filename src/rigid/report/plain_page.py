"""Pages of words, tables and figures, in one file, in which nothing runs.

Words of run directories and participants are strangers': every one of them is escaped, and the
page's own policy allows no script.
"""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from importlib import resources
from importlib.resources.abc import Traversable
from string import Template

_HEAD = resources.files("rigid.report") / "head.html"


def plain_page(template: Traversable, *, title: str, **parts: str) -> str:
    """A page as text.

    Args:
        template: HTML that begins with `$head`; its other names are `title` and the parts.
        title: Any text.
        parts: HTML.
    """
    shown = safe(title)
    head = Template(_HEAD.read_text(encoding="utf-8")).substitute(title=shown)
    return Template(template.read_text(encoding="utf-8")).substitute(
        head=head, title=shown, **parts
    )


def table(heads: Iterable[str], rows: Iterable[Sequence[str]], text: Sequence[int] = ()) -> str:
    """A table of cells that are HTML, as wide as it needs to be; the keyboard can scroll it.

    Args:
        heads: Any texts.
        rows: HTML.
        text: Columns that hold words.
    """

    def line(cells: Iterable[str], element: str) -> str:
        marked = (
            f"<{element}{' class=text' if place in text else ''}>{cell}</{element}>"
            for place, cell in enumerate(cells)
        )
        return f"<tr>{''.join(marked)}</tr>"

    head = line(map(safe, heads), "th")
    body = "\n".join(line(row, "td") for row in rows)
    whole = f"<table><thead>{head}</thead>\n<tbody>\n{body}\n</tbody></table>"
    return f'<div class="wide" tabindex="0">{whole}</div>'


def safe(text: str) -> str:
    """Any text as HTML, for content and for attributes in quotes; lone surrogates included."""
    return html.escape(text).encode("ascii", "xmlcharrefreplace").decode("ascii")

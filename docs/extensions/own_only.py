"""Warns of pages that load anything from another host: readers may be offline, and private."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx
from sphinx.util import logging

_LOADED = {
    "audio": "src", "embed": "src", "iframe": "src", "img": "src", "link": "href", "object": "data",
    "script": "src", "source": "src", "video": "src",
}  # fmt: skip
"""Attributes that browsers follow without being asked; those of `a` wait for a click."""

_logger = logging.getLogger(__name__)


def setup(app: Sphinx) -> dict[str, Any]:
    """Looks through every page and style sheet once they are written."""
    app.connect("build-finished", _check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


class _Requests(HTMLParser):
    """Collects what a page loads."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [value for name, value in attrs if value and name == _LOADED.get(tag)]


def foreign(text: str) -> list[str]:
    """Addresses on other hosts that a page loads.

    Example:
        >>> foreign('<a href="https://a.org"></a><script src="https://b.org/x.js"></script>')
        ['https://b.org/x.js']
        >>> foreign('<link href="//c.org/x.css"><img src="x.png">')
        ['//c.org/x.css']
    """
    page = _Requests()
    page.feed(text)
    return [url for url in page.found if url.startswith(("http:", "https:", "//"))]


def _check(app: Sphinx, exception: Exception | None) -> None:
    if exception is not None or app.builder.format != "html":
        return
    for path in sorted(Path(app.outdir).rglob("*.html")):
        for url in foreign(path.read_text(encoding="utf-8")):
            _logger.warning("%s loads %s from another host", path.relative_to(app.outdir), url)
    for path in sorted(Path(app.outdir).rglob("*.css")):
        text = path.read_text(encoding="utf-8")
        if "url(http" in text or "url(//" in text or "@import" in text:
            _logger.warning("%s loads from another host", path.relative_to(app.outdir))

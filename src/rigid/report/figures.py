"""Figures for papers: one look, and equal bytes from equal data."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid.files import write_atomically

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("#2f6db5", "#c2410c", "#1f7a74", "#8a3fa0", "#b97a00", "#5d6674", "#9aa0ab")
"""Told apart by every kind of colour blindness in this order; those of the report."""
KINDS = (".svg", ".pdf", ".png")
"""Endings of files that a figure can be written to."""
_STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e1da",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "savefig.dpi": 200,  # Of a PNG: sharp on a page and on a slide.
    "svg.hashsalt": "rigid",  # Equal data give equal files.
    "svg.fonttype": "none",
}
_UNDATED: dict[str, dict[str, Any]] = {
    ".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {},
}  # fmt: skip


@contextmanager
def figure(
    path: Path, *, columns: int = 1, rows: int = 1, size: tuple[float, float]
) -> Iterator[Any]:
    """Axes to draw on; written to `path`, whole or not at all, at the end.

    Args:
        path: The figure's file, of one of `KINDS`.
        columns: Axes side by side.
        rows: Axes above each other.
        size: Width and height [inch].

    Yields:
        One axes, or an array of them as `matplotlib.pyplot.subplots` gives.
    """
    to = io.BytesIO()
    with _drawn(to, path.suffix, columns=columns, rows=rows, size=size) as axes:
        yield axes
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, to.getvalue())


@contextmanager
def inline_figure(to: io.StringIO, *, size: tuple[float, float]) -> Iterator[Any]:
    """The same for a page: an `<svg>` element that scales with the text around it.

    Args:
        to: Gets the element.
        size: Width and height [inch], which give it its proportions.

    Yields:
        One axes.
    """
    drawn = io.BytesIO()
    with _drawn(drawn, ".svg", columns=1, rows=1, size=size, transparent=True) as axes:
        yield axes
    text = drawn.getvalue().decode()
    # Without the head of an XML file, and without who made it with what.
    to.write(re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL))


@contextmanager
def _drawn(
    to: io.BytesIO,
    kind: str,
    *,
    columns: int,
    rows: int,
    size: tuple[float, float],
    transparent: bool = False,
) -> Iterator[Any]:
    """Axes whose figure ends up in `to`."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(_STYLE):
        drawn: Figure = Figure(figsize=size, layout="constrained")
        yield drawn.subplots(rows, columns)
        drawn.savefig(
            to, format=kind.removeprefix("."), metadata=_UNDATED[kind], transparent=transparent
        )

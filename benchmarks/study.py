"""What all studies share: parts that are kept once finished, tables, one look of figures."""

from __future__ import annotations

import csv
import io
import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("#2f6db5", "#c2410c", "#1f7a74", "#8a3fa0", "#b97a00", "#5d6674", "#9aa0ab")
"""Told apart by every kind of colour blindness in this order; those of the report."""
_STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e1da",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "svg.hashsalt": "rigid",  # Equal data give equal files.
    "svg.fonttype": "none",
}


def once(path: Path, make: Callable[[], Any]) -> Any:
    """What `path` holds, as JSON; made and kept first where it does not exist.

    Raises:
        UserError: The file is damaged.

    Example:
        >>> import tempfile
        >>> part = Path(tempfile.mkdtemp()) / "part.json"
        >>> once(part, lambda: {"found": 1}), once(part, lambda: {"found": 2})
        ({'found': 1}, {'found': 1})
    """
    cure = "delete it to make it again"
    if path.exists():
        try:
            return json.loads(read_bytes(path, cure=cure))
        except ValueError:
            raise UserError(f"{path} is damaged: {cure}") from None
    made = make()
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, json_text(made, indent=1).encode())
    return json.loads(json_text(made))  # As the next run will read it.


def say(text: str) -> None:
    """A line of progress with the time of day."""
    print(f"{time.strftime('%H:%M:%S')}  {text}", flush=True)


def write_table(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """Rows of equal keys as CSV; unknown values are empty."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: _cell(value) for key, value in row.items()} for row in rows)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, text.getvalue().encode())


def _cell(value: object) -> object:
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else value


@contextmanager
def figure(
    path: Path, *, columns: int = 1, rows: int = 1, size: tuple[float, float]
) -> Iterator[Any]:
    """Axes to draw on; written to `path` (.svg or .pdf) at the end.

    Args:
        path: The figure's file.
        columns: Axes side by side.
        rows: Axes above each other.
        size: Width and height [inch].

    Yields:
        One axes, or an array of them as `matplotlib.pyplot.subplots` gives.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(_STYLE):
        drawn: Figure = Figure(figsize=size, layout="constrained")
        yield drawn.subplots(rows, columns)
        path.parent.mkdir(parents=True, exist_ok=True)
        drawn.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)

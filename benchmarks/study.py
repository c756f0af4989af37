"""What all studies share: parts that are kept once finished, tables, one look of figures."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically
from rigid.report.figures import COLOURS, figure
from rigid.report.tables import csv_text

__all__ = ["COLOURS", "figure", "once", "say", "write_table"]


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
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, csv_text(rows).encode())

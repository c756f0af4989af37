"""One HTML file from a payload and the bundled front end.

The payload may hold texts of strangers (a foreign frontier.json): it enters the page as inert JSON,
and the front end only ever writes it as text.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
import math
import os
import tempfile
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from string import Template

import numpy as np

from rigid.errors import UserError

_PACKAGE = resources.files("rigid.report")

# What is only drawn keeps as many digits as a screen can show; frontier.json stays verbatim.
DRAWN = ("band", "learning", "replays", "discriminators")
DRAWN_DIGITS = 5

# Within JSON these occur only in strings, where \u escapes stand for the same character.
_ESCAPES = str.maketrans({"<": "\\u003c", ">": "\\u003e", "&": "\\u0026"})


def build_report(payload: Mapping[str, object], out: Path) -> Path:
    """Writes the report of one frontier, atomically, and returns its path.

    Args:
        payload: What the page shows: `rigid.report.payload.Payload`. Whatever is missing is shown
            as unknown.
        out: The HTML file.

    Raises:
        UserError: The front end was not bundled, or `out` cannot be written.
    """
    page = render_page(payload, script=_bundled("report.js"), style=_bundled("report.css"))
    _write_atomically(out, page.encode("utf-8"))
    return out


def render_page(payload: Mapping[str, object], *, script: str, style: str) -> str:
    """Returns the page as text: template, front end and payload in one."""
    frontier = payload.get("frontier")
    robot, task = "robot", "task"
    if isinstance(frontier, Mapping):
        robot, task = str(frontier.get("robot", robot)), str(frontier.get("task", task))
    code = _harmless(script, "script")
    digest = base64.b64encode(hashlib.sha256(code.encode("utf-8")).digest()).decode("ascii")
    template = Template((_PACKAGE / "page.html").read_text(encoding="utf-8"))
    return template.substitute(
        title=_ascii(html.escape(f"{robot} on {task} · RIGID")),
        script_hash=f"sha256-{digest}",
        style=_harmless(style, "style"),
        script=code,
        payload=embed_json(_lightened(payload)),
    )


def _lightened(payload: Mapping[str, object]) -> dict[str, object]:
    """Returns the payload with curves at drawing precision: they are most of its size."""
    drawn = {key: _plain(payload[key], DRAWN_DIGITS) for key in DRAWN if key in payload}
    return {**payload, **drawn}


def embed_json(value: object) -> str:
    r"""Returns JSON that is safe inside an HTML script element.

    Everything beyond ASCII becomes a \u escape, U+2028 and lone surrogates included. NaN and ±∞,
    which JSON lacks, become null: unknown.

    Example:
        >>> print(embed_json({"robot": "</script>"}))
        {"robot":"\u003c/script\u003e"}
    """
    text = json.dumps(_plain(value), ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.translate(_ESCAPES)


def _plain(value: object, digits: int | None = None) -> object:
    """Returns `value` as JSON types; arrays become lists, numbers that are not finite null.

    Args:
        value: Anything made of mappings, sequences, arrays and scalars.
        digits: Significant digits to keep; None keeps all.
    """
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): _plain(inner, digits) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner, digits) for inner in value]
    if isinstance(value, float):
        return _number(value, digits)
    return value


def _number(value: float, digits: int | None) -> float | None:
    if not math.isfinite(value):
        return None
    return value if digits is None else float(f"{value:.{digits}g}")


def _harmless(code: str, element: str) -> str:
    """Returns bundled code that cannot close the element it is in."""
    if f"</{element}" in code.lower():
        raise ValueError(f"the bundle holds </{element}, which would end its element")
    return code


def _ascii(text: str) -> str:
    """Returns text with character references for all that UTF-8 might refuse."""
    return text.encode("ascii", "xmlcharrefreplace").decode("ascii")


def _bundled(name: str) -> str:
    source = _PACKAGE / "static" / name
    if not source.is_file():
        raise UserError(
            f"the report's front end is not bundled: {name} is missing. In a checkout, run "
            "`npm --prefix web ci && npm --prefix web run build`, or install the package again"
        )
    return source.read_text(encoding="utf-8")


def _unwritable(path: Path, error: OSError) -> str:
    return f"cannot write the report {path} ({error.strerror}): choose another place with --out"


def _write_atomically(path: Path, data: bytes) -> None:
    """Replaces `path` at once, so that nobody ever opens half a report."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as error:
        raise UserError(_unwritable(path, error)) from None
    temporary = Path(name)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(data)
        temporary.chmod(0o644)
        temporary.replace(path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise UserError(_unwritable(path, error)) from None

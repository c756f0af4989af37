"""`rigid verify`: learning against exact answers."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import tyro

from rigid.commands.parsing import parse_lambdas

_shown_as = tyro.conf.arg
CHECK_FAILED = 1


@dataclass(frozen=True, kw_only=True)
class VerifyCommand:
    """Check search and referee on tasks whose frontier is known exactly; exit 1 when a row is off.

    Examples:
      rigid verify --json verify.json
      rigid verify --lambdas 6,20
    """

    lambdas: Annotated[str | None, _shown_as(metavar="LAMBDAS")] = None
    """Only these weights of the default penalty, and no areas; by default 4,5,6,8,10,20."""
    json: Annotated[Path | None, _shown_as(metavar="FILE")] = None
    """Write every row to this file as well."""

    def run(self) -> int:
        """Trains, compares and prints."""
        chosen = parse_lambdas(self.lambdas)
        from rigid.commands.terminal.progress import TerminalListener
        from rigid.compute.verification.plan import plan_verification
        from rigid.files import json_text, make_room, write_atomically, writing_to

        if self.json is not None:
            make_room(self.json, "--json")
        plan = plan_verification(chosen)
        begun = time.monotonic()
        with TerminalListener("verifying") as listener:
            listener.say("trying out how fast training is here")
            listener.begin(plan.workload())
            result = plan.run(listener.advance, listener.say)
        result["wall_seconds"] = time.monotonic() - begun
        print(table(result))
        if self.json is not None:
            with writing_to(self.json, "--json"):
                write_atomically(self.json, json_text(result, indent=1).encode())
        return 0 if result["ok"] else CHECK_FAILED


def table(result: Mapping[str, Any]) -> str:
    """What was measured beside what is exact, as text."""
    lines: list[str] = []
    for title, columns in (("rows", _ROWS), ("areas", _AREAS), ("tracking", _TRACKING)):
        found = result.get(title)
        if found:
            lines += ["", "  ".join(f"{name:>{width}}" for name, width in columns)]
            lines += [_line(row, columns) for row in found]
    off = sum(not row["ok"] for part in ("rows", "areas", "tracking") for row in result[part])
    verdict = "every row agrees" if off == 0 else f"{off} rows are off"
    return "\n".join([*lines, "", f"{verdict}; {result['wall_seconds']:.0f} s"])


_Columns = Sequence[tuple[str, int]]
_ROWS: _Columns = (
    ("setting", 16), ("lambda", 7), ("shift", 7), ("shift_exact", 11), ("naturalness", 11),
    ("naturalness_exact", 17), ("overlap", 7), ("overlap_exact", 13), ("ok", 3),
)  # fmt: skip
_AREAS: _Columns = (("tolerance", 9), ("axis", 11), ("area", 7), ("area_exact", 10), ("ok", 3))
_TRACKING: _Columns = (
    ("lambda", 7), ("cost", 7), ("cost_exact", 10), ("kl", 7), ("kl_exact", 8), ("ok", 3),
)  # fmt: skip


def _line(row: Mapping[str, Any], columns: _Columns) -> str:
    return "  ".join(f"{_text(row[name]):>{width}}" for name, width in columns)


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "NO"
    return f"{value:.4g}" if isinstance(value, float) else str(value)

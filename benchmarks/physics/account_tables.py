"""The tables of the account, in Markdown: a line for each case and step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from benchmarks.paired import find, markdown
from benchmarks.physics.plan import (
    AGED,
    DEFAULT,
    FINEST,
    LIMITS,
    PAIRS,
    SETTINGS,
    SPEEDS,
    SWINGS,
    WINDOW_REFERENCE,
)
from benchmarks.physics.tables import AGED_NUMBERS, Row
from benchmarks.physics.verdicts import worst

_CLOSED = {
    "return": "return", "success": "success", "counted": "counted contacts",
    "peak_force": "peak force [N]", "impulse": "impulse [N s]",
    "penetration": "deepest overlap [mm]", "deepest": "of all [mm]", "faulted": "faulted",
    "angles": "angles after 0.5 s",
}  # fmt: skip
_WINDOWS = {
    "impulse": "impulse [N s]", "impulse_error": "its error",
    "peak_force": "peak force [N]", "penetration": "deepest overlap [mm]",
    "angles_rad": "angles [rad]", "angles": "[deviations]", "features": "features",
}  # fmt: skip
_FORMS = {
    "return": (".1f", 1), "success": (".3f", 1), "counted": (".1f", 1), "peak_force": (".2f", 1),
    "impulse": (".3f", 1), "impulse_error": (".1%", 1), "penetration": (".2f", 1000),
    "deepest": (".1f", 1000), "faulted": (".1%", 1), "angles": (".3f", 1),
    "angles_rad": (".4f", 1), "features": (".3f", 1), "growth": (".2%", 1), "worst": (".1%", 1),
    "cost": (".2f", 1),
}  # fmt: skip
_RELATIVE = {"peak_force", "impulse"}


def number_text(row: Row) -> str:
    """The difference to the reference with its interval where there is one, else the value's.

    Example:
        >>> row = {"number": "impulse", "difference": 0.02, "difference_low": 0.01}
        >>> number_text(row | {"difference_high": 0.03})
        '+2.0 % [+1.0 %, +3.0 %]'
    """
    if row["difference"] is not None:
        form, unit = _FORMS[row["number"]]
        form = ".1%" if row["number"] in _RELATIVE else form
        ends = [row[key] * unit for key in ("difference", "difference_low", "difference_high")]
        return _bracketed(ends, f"+{form}")
    form, unit = _FORMS[row["number"]]
    return _bracketed([row[key] * unit for key in ("value", "low", "high")], form)


def value_text(row: Row) -> str:
    """The value alone."""
    form, unit = _FORMS[row["number"]]
    return _plain(row["value"] * unit, form)


def verdict_table(rows: Sequence[Row]) -> str:
    """A line for each limit: the worst verdict over all cases at each step."""
    lines = []
    for limit in LIMITS:
        found = [worst(rows, limit, one) for one in SETTINGS]
        cells = [
            {"fails": "**fails**", "open": "*open*", None: "reference"}.get(one, one)
            for one in found
        ]
        lines.append([limit.text, *(str(cell) for cell in cells)])
    return markdown(["limit", *(one.name for one in SETTINGS)], lines)


def closed_table(rows: Sequence[Row]) -> str:
    """Values at the finest step, then the differences of the others."""
    return _compared(rows, "closed", [one.step for one in SETTINGS], _CLOSED)


def aged_table(rows: Sequence[Row]) -> str:
    """The difference of steps as a whole, by old poses, and by the rest."""
    lines = []
    for pair in AGED:
        for name in AGED_NUMBERS:
            whole, rest, age = (
                find(rows, part=part, case=pair, step=one.step, number=name)
                for part, one in (("closed", DEFAULT), ("aged", DEFAULT), ("aged", FINEST))
            )
            texts = [number_text(row) for row in (whole, age, rest)]
            lines.append([f"*{pair}*", _CLOSED[name], *texts])
    return markdown(
        ["human", "", f"{DEFAULT.name} against {FINEST.name}", "by older poses", "by all else"],
        lines,
    )


def window_table(rows: Sequence[Row]) -> str:
    """Values at the reference, then the differences of the others."""
    steps = [*(one.step for one in SETTINGS), WINDOW_REFERENCE.step]
    return _compared(rows, "windows", steps, _WINDOWS)


def energy_table(rows: Sequence[Row]) -> str:
    """Mean gain of energy with its interval, and the worst swing's."""
    lines = []
    for swing in SWINGS:
        for speed in SPEEDS:
            case = f"{swing}, {speed:g} rad/s"
            cells = []
            for one in SETTINGS:
                mean, most = (
                    find(rows, part="energy", case=case, step=one.step, number=number)
                    for number in ("growth", "worst")
                )
                cells.append(f"{number_text(mean)}, worst {value_text(most)}")
            lines.append([f"*{swing}*, {speed:g} rad/s", *cells])
    return markdown(["", *(one.name for one in SETTINGS)], lines)


def _compared(
    rows: Sequence[Row], part: str, steps: Sequence[float], columns: Mapping[str, str]
) -> str:
    lines = []
    for pair in PAIRS:
        for step in steps[::-1]:
            mine = {
                row["number"]: row for row in rows
                if (row["part"], row["case"], row["step"]) == (part, pair, step)
            }  # fmt: skip
            lines.append([f"*{pair}*", f"{step:g} s", *(_cell(mine.get(name)) for name in columns)])
    return markdown(["human", "step", *columns.values()], lines)


def _cell(row: Row | None) -> str:
    """The value of a reference, the difference of all others, nothing where there is none."""
    if row is None:
        return ""
    if row["difference"] is None and row["low"] is None:
        return value_text(row)
    return number_text(row)


def _bracketed(numbers: Sequence[float], form: str) -> str:
    first, low, high = (_plain(one, form) for one in numbers)
    return f"{first} [{low}, {high}]"


def _plain(number: float, form: str) -> str:
    # Adding 0 after rounding turns -0.0 into 0.0.
    digits = int(form.lstrip("+").lstrip(".").rstrip("f%")) + (2 if form.endswith("%") else 0)
    return f"{round(number, digits) + 0.0:{form}}".replace("%", " %")

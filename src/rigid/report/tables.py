"""Tables of a comparison of methods, for programs (CSV) and for papers (LaTeX)."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, Final

from rigid.frontier.intervals import Interval
from rigid.frontier.methods import Estimate, Method
from rigid.frontier.successes import Success

Row = dict[str, Any]
COLUMNS: Final = MappingProxyType({
    "worst_at": "worst_at_0.9", "auc_natural": "auc_natural", "auc": "auc",
})  # fmt: skip
"""The headline numbers, and how columns call them."""
_TITLES: Final = MappingProxyType({
    "worst_at_0.9": r"worst at $\geq$ .9 $\downarrow$",
    "auc_natural": r"area $[.8, 1]$ $\downarrow$",
    "auc": r"AUC $\downarrow$",
    "success": r"Success $\uparrow$",
    "unseen": r"Success, unseen humans $\uparrow$",
})  # fmt: skip
_DIGITS: Final = MappingProxyType({"success": 2, "unseen": 2})
"""Of columns that do not have three; as in the paper."""
_LATEX: Final = str.maketrans(
    {sign: f"\\{sign}" for sign in "&%$#_{}"}
    | {
        "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
        "<": r"\textless{}", ">": r"\textgreater{}",
    }
)  # fmt: skip


def method_row(method: Method, success: Success | None) -> Row:
    """A row of the comparison, with the columns of `results/paper/table.csv`.

    `_vs_vanilla_high` is the upper end of the 95 % interval of the difference to the first method,
    whatever that is called.

    Args:
        method: From `compare_methods`.
        success: With the robots' own synthetic humans.
    """
    row: Row = {"method": method.name}
    for number, column in COLUMNS.items():
        row |= with_ends(column, method.numbers[number])
        if number != "auc":
            against = None if method.against is None else method.against[number].interval
            row[f"{column}_vs_vanilla_high"] = None if against is None else against.high
    row["auc_paper_axis"] = method.auc_paper_axis
    row |= with_ends("success", success)
    return {**row, "robot_seeds": method.robots, "search_seeds": method.seeds}


def with_ends(column: str, found: Estimate | Success | None) -> Row:
    """A number in three columns: itself and both ends of its interval; unknown ones are None.

    Example:
        >>> with_ends("auc", Estimate(0.5, None))
        {'auc': 0.5, 'auc_low': None, 'auc_high': None}
    """
    ends: Interval | None = None if found is None else found.interval
    return {
        column: None if found is None else found.mean,
        f"{column}_low": None if ends is None else ends.low,
        f"{column}_high": None if ends is None else ends.high,
    }


def csv_text(rows: Sequence[Mapping[str, Any]]) -> str:
    r"""Rows of equal keys as CSV, floats with four digits; unknown values are empty.

    Example:
        >>> csv_text([{"method": "palm", "auc": 0.66789, "auc_low": None}])
        'method,auc,auc_low\npalm,0.6679,\n'
    """
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: _plain(value) for key, value in row.items()} for row in rows)
    return text.getvalue()


def latex(rows: Sequence[Row], titles: Mapping[str, str] | None = None) -> str:
    """The paper's table (method, AUC, success) with the headline numbers and 95 % intervals.

    It needs the package booktabs.

    Args:
        rows: From `method_row`; those with a column `unseen` get one here.
        titles: How methods are called here, by their name.
    """
    columns = [column for column in _TITLES if column in rows[0]]
    head = f"Method & {' & '.join(_TITLES[column] for column in columns)} " + r"\\"
    lines = [rf"\begin{{tabular}}{{l{'c' * len(columns)}}}", r"\toprule", head, r"\midrule"]
    for row in rows:
        name = (titles or {}).get(row["method"], row["method"])
        cells = [in_latex(name), *(_cell(row, column) for column in columns)]
        lines.append(f"{' & '.join(cells)} " + r"\\")
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}", ""])


def in_latex(text: str) -> str:
    r"""Any text as LaTeX prints it.

    Example:
        >>> print(in_latex(r"robust_gt 50 % \input"))
        robust\_gt 50 \% \textbackslash{}input
    """
    return text.translate(_LATEX)


def _cell(row: Row, column: str) -> str:
    value, low, high = row[column], row[f"{column}_low"], row[f"{column}_high"]
    form = f".{_DIGITS.get(column, 3)}f"
    if value is None:
        return "--"
    return f"{value:{form}}" if low is None else f"{value:{form}} [{low:{form}}, {high:{form}}]"


def _plain(value: object) -> object:
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else value

"""Tables of text: CSV files as people export them, columns by name.

Comma, semicolon or tab; a header line; a byte order mark is let be. Nothing is guessed about what
a column means: that is the map's (`rigid.data.column_map`).
"""

from __future__ import annotations

import csv
import io
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from rigid.data.column_map import ColumnMap
from rigid.errors import UserError
from rigid.files import read_bytes

_UNKNOWN = ("", "nan", "na", "n/a", "null", "none")
"""What people write where a number is missing, in small letters."""
_SHOWN = 10
"""Texts of a column that a message lists. Ours."""

Cells = Sequence[Any] | np.ndarray
"""Texts as they stand in a file, or numbers."""


class Table(NamedTuple):
    """Rows of one file."""

    name: str
    """Of the file, without its ending."""
    columns: Mapping[str, Cells]
    map_: ColumnMap

    @property
    def rows(self) -> int:
        """How many there are."""
        return len(next(iter(self.columns.values())))

    @property
    def names(self) -> frozenset[str]:
        """Every name that can be asked for: mapped ones, and columns that no map renames."""
        taken = {column.source for column in self.map_.values()}
        return frozenset(self.map_.keys() | (self.columns.keys() - taken))

    def texts(self, name: str) -> list[str]:
        """A column as it stands in the file."""
        column = self.map_.get(name)
        if column is None:
            return [str(cell) for cell in self.columns[name]]
        if column.source is None:
            return [str(column.value)] * self.rows
        return [str(cell) for cell in self.columns[column.source]]

    def numbers(self, name: str) -> Float[np.ndarray, " rows"]:
        """A column as numbers, converted as the map says; NaN where there is none.

        Raises:
            UserError: A text is no number.
        """
        column = self.map_.get(name)
        if column is None:
            return self._parsed(name, self.columns[name])
        if column.source is None:
            return np.full(self.rows, column.value)
        cells = self.columns[column.source]
        if column.equals is not None:
            return np.array([_equal(str(cell).strip(), column.equals) for cell in cells])
        return self._parsed(column.source, cells) * column.factor + column.offset

    def _parsed(self, name: str, cells: Cells) -> Float[np.ndarray, " rows"]:
        try:
            return np.array(cells, dtype=np.float64)
        except ValueError:
            return np.array([self._number(name, row, str(cell)) for row, cell in enumerate(cells)])

    def _number(self, name: str, row: int, text: str) -> float:
        if text.strip().lower() in _UNKNOWN:
            return np.nan
        try:
            return float(text)
        except ValueError:
            raise UserError(
                f"{self.name}: row {row + 1}, column {name!r} holds {text!r}, which is no number: "
                "write numbers with a point, and leave a cell empty where nothing was measured"
            ) from None


def _equal(text: str, wanted: str) -> float:
    if text == wanted:
        return 1.0
    return np.nan if text.lower() in {"", "nan"} else 0.0


def check_map(tables: Sequence[Table], map_: ColumnMap, *, where: str) -> None:
    """Refuses a map that takes from columns, or looks for texts, that are not there.

    Raises:
        UserError: A table lacks a column, or no table holds the text of an `equals`.
    """
    for table in tables:
        for name, column in map_.items():
            if column.source is not None and column.source not in table.columns:
                raise UserError(
                    f"{where}: {table.name} has no column {column.source!r}, from which the map "
                    f"takes {name!r}; columns: {', '.join(table.columns)}"
                )
    for name, column in map_.items():
        if column.source is None or column.equals is None:
            continue
        texts = {str(cell).strip() for table in tables for cell in table.columns[column.source]}
        if column.equals not in texts:
            raise UserError(
                f"{where}: column {column.source!r} nowhere holds {column.equals!r}, from which "
                f"the map takes {name!r}; it holds {_some(texts - {''})}"
            )


def _some(texts: Collection[str]) -> str:
    shown = [repr(text) for text in sorted(texts)[:_SHOWN]]
    more = len(texts) - len(shown)
    return (", ".join(shown) or "nothing") + (f" and {more} others" if more > 0 else "")


def read_tables(path: Path, map_: ColumnMap) -> list[Table]:
    """The tables of a CSV file, or of every CSV file in a folder.

    Raises:
        UserError: There are none, one is no table, or lacks a column that the map names.
    """
    paths = sorted(path.glob("*.csv")) if path.is_dir() else [path]
    if not paths:
        raise UserError(f"{path} holds no .csv files: name a CSV file or a folder of them")
    tables = [_read(file, map_) for file in paths]
    check_map(tables, map_, where=str(path))
    return tables


def _read(path: Path, map_: ColumnMap) -> Table:
    cure = "give a CSV file with a header line"
    try:
        text = read_bytes(path, cure=cure).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise UserError(f"{path} is no UTF-8 text ({error.reason}): {cure}") from None
    head = text.partition("\n")[0]
    delimiter = max(",;\t", key=head.count)
    try:
        header, *rows = [row for row in csv.reader(io.StringIO(text), delimiter=delimiter) if row]
    except (ValueError, csv.Error):
        raise UserError(f"{path} is empty or no table: {cure}") from None
    names = [name.strip() for name in header]
    _check(path, names, rows)
    columns = dict(zip(names, (list(column) for column in zip(*rows, strict=True)), strict=True))
    return Table(path.stem, columns, map_)


def _check(path: Path, names: list[str], rows: list[list[str]]) -> None:
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise UserError(f"{path} has two columns {twice!r}: name each one once")
    if not rows:
        raise UserError(f"{path} has a header and no rows: record something")
    for number, row in enumerate(rows):
        if len(row) != len(names):
            raise UserError(
                f"{path}: row {number + 1} has {len(row)} cells, but the header {len(names)}: "
                "write every row in full, with empty cells where nothing was measured"
            )

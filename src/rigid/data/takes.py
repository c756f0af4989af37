"""Takes: episodes as somebody recorded them, each with its own clock, before they are resampled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Shaped

from rigid.data.about import EpisodeNote
from rigid.data.layout import TEXTS
from rigid.data.tables import Table
from rigid.errors import UserError

EPISODE, TIME, STEP = "episode", "time", "step"


@dataclass(frozen=True)
class Take:
    """One recorded episode of n rows."""

    name: str
    clock: Float[np.ndarray, " n"]
    """When each row was taken [s], or the number of its control step."""
    signals: Mapping[str, Shaped[np.ndarray, "n ..."]]
    """Columns of numbers; NaN where there is none."""
    texts: Mapping[str, tuple[str, ...]]
    """The different texts of a column, in their order; more than one is a mixed recording."""
    ends: Mapping[str, float]
    """Numbers of the whole episode (return, success, seed): the last one that was given."""

    def note(self) -> EpisodeNote:
        """What is told of it."""
        said = {name: ", ".join(found) for name, found in self.texts.items()}
        return EpisodeNote(name=self.name, **said)


class Recording(NamedTuple):
    """Every take of a source."""

    where: str
    """The source, for messages."""
    takes: tuple[Take, ...]
    sampled: bool
    """Whether rows are samples in time; else they are control steps."""
    offered: frozenset[str]
    """Names of all columns of the source."""

    @property
    def columns(self) -> frozenset[str]:
        """Columns of numbers that every take has."""
        return frozenset.intersection(*(frozenset(take.signals) for take in self.takes))


def takes_of(
    tables: Sequence[Table], wanted: frozenset[str], *, rate: float | None, where: str
) -> Recording:
    """The takes in tables, one for each value of `episode`; a table without it is one take.

    Args:
        tables: In the long format: a row for each moment of each episode.
        wanted: Columns of numbers that are read where they are there.
        rate: Samples a second [Hz], where rows are numbered by `step`; None: steps are the task's.
        where: The source; begins every message.

    Raises:
        UserError: Neither `time` nor `step` is there, or the rate is given twice.
    """
    clocks = {TIME if TIME in table.names else STEP for table in tables}
    for table in tables:
        if not {TIME, STEP} & table.names:
            raise UserError(
                f"{where}: {table.name} has neither a column 'time' [s] nor 'step'; it has "
                f"{', '.join(sorted(table.names))}: name one with --map"
            )
    if len(clocks) > 1:
        raise UserError(f"{where}: some files have a column 'time' and some only 'step': mend them")
    if TIME in clocks and rate is not None:
        raise UserError(f"--rate is {rate:g}, but {where} says when rows were taken: leave it out")
    single = len(tables) == 1
    takes = [take for table in tables for take in _split(table, wanted, rate=rate, single=single)]
    offered = frozenset().union(*(table.names for table in tables))
    return Recording(where, tuple(takes), TIME in clocks or rate is not None, offered)


def _split(table: Table, wanted: frozenset[str], *, rate: float | None, single: bool) -> list[Take]:
    labels = table.texts(EPISODE) if EPISODE in table.names else [table.name] * table.rows
    sampled = TIME in table.names
    clock = table.numbers(TIME if sampled else STEP) / (1.0 if rate is None else rate)
    signals = {name: table.numbers(name) for name in wanted & table.names}
    texts = {name: table.texts(name) for name in TEXTS if name in table.names}
    rows: dict[str, list[int]] = {}
    for row, label in enumerate(labels):
        rows.setdefault(label.strip(), []).append(row)
    alone = EPISODE not in table.names or single
    return [
        take_of(
            label if alone else f"{table.name}/{label}",
            clock[picked],
            {name: column[picked] for name, column in signals.items()},
            {name: tuple(dict.fromkeys(column[row].strip() for row in picked))
             for name, column in texts.items()},
        )
        for label, picked in rows.items()
    ]  # fmt: skip


def take_of(
    name: str,
    clock: Float[np.ndarray, " n"],
    signals: Mapping[str, Shaped[np.ndarray, "n ..."]],
    texts: Mapping[str, tuple[str, ...]],
) -> Take:
    """A take, with the last known number of each column for what is told once an episode."""
    ends = {key: _last(column) for key, column in signals.items() if column.ndim == 1}
    return Take(name, clock, signals, texts, ends)


def _last(column: Float[np.ndarray, " n"]) -> float:
    known = column[np.isfinite(column)]
    return float(known[-1]) if len(known) else np.nan

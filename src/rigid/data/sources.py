"""Where recordings come from: `FILE.csv`, a folder of CSV files, `minari:ID`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationError

from rigid.data.about import About
from rigid.data.column_map import Column, ColumnMap
from rigid.data.csv_files import read_beside
from rigid.data.episodes import Source
from rigid.data.importing import wanted_columns
from rigid.data.layout import OBSERVATION
from rigid.data.minari_files import PREFIX
from rigid.data.minari_reading import read_minari
from rigid.data.tables import check_map, read_tables
from rigid.data.takes import Recording, takes_of
from rigid.errors import UserError
from rigid.tasks.protocol import Task, control_period


class Opened(NamedTuple):
    """A recording and what came with it."""

    recording: Recording
    about: About
    """As a Minari dataset of RIGID's keeps it."""
    source: Source
    provenance: Mapping[str, Any]


def open_source(spec: str, task: Task, map_: ColumnMap, *, rate: float | None) -> Opened:
    """Reads a recording.

    Args:
        spec: A CSV file, a folder of them, or `minari:ID` (or `minari:DIRECTORY`).
        task: Whose columns are wanted.
        map_: Renames columns.
        rate: Samples a second [Hz] where rows are only numbered.

    Raises:
        UserError: There is nothing, it cannot be read, or lacks a clock.
    """
    if rate is not None and not 0 < rate < float("inf"):
        raise UserError(f"--rate is {rate:g}, but must be samples a second, more than 0")
    wanted = wanted_columns(task)
    if not spec.startswith(PREFIX):
        path = Path(spec)
        if not path.exists():
            raise UserError(f"{path} does not exist: give a CSV file, a folder or minari:ID")
        takes = takes_of(read_tables(path, map_), wanted, rate=rate, where=spec)
        return _opened(takes, read_beside(path))
    if rate is not None and abs(rate * control_period(task) - 1) < 1e-6:
        rate = None  # The task's own: nothing to resample.
    tables, own = read_minari(spec.removeprefix(PREFIX), map_, rate=rate)
    check_map(tables, map_, where=spec)
    seen = _seen_features(task, tables[0].names, map_, sampled=rate is not None)
    tables = [table._replace(map_={**seen, **map_}) for table in tables]
    recording = takes_of(tables, wanted, rate=rate, where=spec)
    return _opened(recording, own)


def _opened(recording: Recording, own: Mapping[str, Any]) -> Opened:
    """With what RIGID itself laid beside the episodes, if anything."""
    said, made_by = (own.get(part) for part in ("about", "provenance"))
    said, made_by = (part if isinstance(part, dict) else {} for part in (said, made_by))
    try:
        about = About(consent=said.get("consent"), licence=said.get("licence"))
    except ValidationError as error:
        first = error.errors()[0]
        raise UserError(
            f"what lies beside {recording.where} is damaged: about.{first['loc'][0]}: "
            f"{first['msg']}; mend it, or take it away"
        ) from None
    synthetic = own.get("source") == "synthetic"
    return Opened(recording, about, "synthetic" if synthetic else "recorded", made_by)


def _seen_features(
    task: Task, names: frozenset[str], map_: ColumnMap, *, sampled: bool
) -> dict[str, Column]:
    """Features that the human observes under the same name, where the dataset tells no features."""
    observed = task.human.observation_names
    prefix = OBSERVATION if sampled else f"next_{OBSERVATION}"
    return {
        name: Column.model_validate({"from": f"{prefix}{observed.index(name)}"})
        for name in task.feature_names
        if name in observed and name not in names and name not in map_
    }

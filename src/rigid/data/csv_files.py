"""Episodes as a CSV table: a row for each control step of each episode, to look at and to edit.

What a table has no room for, such as consent and licence, lies beside it in `FILE.csv.json`.
`rigid data import` reads both again, to the same numbers.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rigid.data.episodes import CanonicalEpisodes, beside
from rigid.data.layout import ACTION, OBSERVATION, TEXTS
from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically


def write_csv(episodes: CanonicalEpisodes, path: Path) -> None:
    """Writes episodes in the long format, with every digit of float32.

    Args:
        episodes: Any.
        path: File to write.
    """
    count, steps = episodes.features.shape[:2]
    columns: dict[str, np.ndarray] = {
        "step": np.tile(np.arange(steps), (count, 1)),
        **dict(zip(episodes.feature_names, np.moveaxis(episodes.features, -1, 0), strict=True)),
    }
    for prefix, array in ((OBSERVATION, episodes.observations), (ACTION, episodes.actions)):
        if array is not None:
            columns |= {f"{prefix}{i}": part for i, part in enumerate(np.moveaxis(array, -1, 0))}
    if episodes.rewards is not None:
        columns["reward"] = episodes.rewards
    for name, column in (
        ("seed", episodes.seeds), ("return", episodes.returns), ("success", episodes.success),
    ):  # fmt: skip
        columns[name] = np.broadcast_to(column[:, np.newaxis], (count, steps))
    notes, labels = episodes.about.episodes, _labels(episodes)
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(["episode", *columns, *(TEXTS if notes else ())])
    for episode in range(count):
        said = [getattr(notes[episode], name) for name in TEXTS] if notes else []
        table = [_texts(column[episode]) for column in columns.values()]
        writer.writerows([labels[episode], *row, *said] for row in zip(*table, strict=True))
    write_atomically(path, buffer.getvalue().encode())
    text = json_text(beside(episodes), indent=1) + "\n"
    write_atomically(beside_csv(path), text.encode())


def beside_csv(path: Path) -> Path:
    """Where what goes with a table lies."""
    return path.with_name(f"{path.name}.json")


def read_beside(path: Path) -> Mapping[str, Any]:
    """What goes with a table; nothing where there is no such file.

    Raises:
        UserError: It is damaged.
    """
    file = beside_csv(path)
    if path.is_dir() or not file.exists():
        return {}
    try:
        found = json.loads(read_bytes(file, cure="delete it"))
    except ValueError as error:
        raise UserError(f"{file} is no JSON ({error}): mend it, or delete it") from None
    return found if isinstance(found, dict) else {}


def _labels(episodes: CanonicalEpisodes) -> list[str]:
    """A name for each episode: the recording's, or its number where that is none of its own."""
    names = [note.name for note in episodes.about.episodes]
    unique = len(set(names)) == len(episodes) and all(names)
    return names if unique else [str(number) for number in range(len(episodes))]


def _texts(column: np.ndarray) -> list[str]:
    if column.dtype.kind in "iu":
        return [str(number) for number in column]
    return ["" if np.isnan(number) else f"{number:.9g}" for number in column]

"""Minari datasets as tables, whoever wrote them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium import spaces
from jaxtyping import Shaped

from rigid.data.column_map import ColumnMap
from rigid.data.minari_files import OWN, installed_minari
from rigid.data.tables import Table
from rigid.errors import UserError


def read_minari(
    spec: str, map_: ColumnMap, *, rate: float | None
) -> tuple[list[Table], Mapping[str, Any]]:
    """The episodes of a dataset as tables, and what RIGID noted in its metadata.

    Rows are control steps: `observation_I`, `action_I` and `reward` of the step, and, as features
    are of the state that it led to, `next_observation_I` and the dataset's infos. At another rate
    than the task's, rows are samples: T + 1 of them, the last action and reward once more.

    Args:
        spec: Id of a dataset that Minari has on this machine, or its directory.
        map_: Renames columns.
        rate: Steps a second [Hz]; None: as many as the task's.

    Raises:
        UserError: There is no such dataset, it is of a robot, or says not what it holds.
    """
    dataset = _open(spec)
    own = dataset.storage.metadata.get(OWN, {})
    if own.get("agent", "human") != "human":
        raise UserError(f"{spec} is the {own['agent']}'s view: import the human's")
    names = tuple(own.get("feature_names", ()))
    notes = dataset.storage.get_episode_metadata(dataset.episode_indices)
    tables = []
    for episode, note in zip(dataset, notes, strict=True):
        columns = _columns(dataset, episode, names, sampled=rate is not None)
        rows = len(columns["step"])
        told = {
            name: [note[name]] * rows
            for name in ("seed", "participant", "device", "robot", "notes", "return", "success")
            if name in note
        }
        label = str(note.get("name", "")) or str(episode.id)
        tables.append(Table(label, {**columns, **told}, map_))
    if not tables:
        raise UserError(f"{spec} holds no episodes: record some")
    return tables, own


def _columns(dataset: Any, episode: Any, names: Sequence[str], *, sampled: bool) -> dict[str, Any]:
    seen = _flat(dataset.observation_space, episode.observations)
    done = _flat(dataset.action_space, episode.actions)
    steps = len(done)
    # The columns of a state are given at all T + 1 moments, or at the T that steps led to.
    told = {"reward": np.asarray(episode.rewards)}
    told |= {f"action_{i}": column for i, column in enumerate(done.T)}
    if sampled:
        told = {name: np.append(column, column[-1:]) for name, column in told.items()}
    before = slice(None) if sampled else slice(steps)
    states = {f"observation_{i}": column[before] for i, column in enumerate(seen.T)}
    if not sampled:
        states |= {f"next_observation_{i}": column[1:] for i, column in enumerate(seen.T)}
    for name, info in (episode.infos or {}).items():
        rows = np.asarray(info)
        if rows.dtype.kind not in "iufb" or len(rows) not in {steps, steps + 1}:
            continue  # Text and what is not told at every step.
        rows = rows.reshape(len(rows), -1)
        if sampled and len(rows) == steps:
            rows = np.append(rows[:1], rows, axis=0)
        rows = rows if sampled else rows[-steps:]
        called = names if name == "features" and len(names) == rows.shape[1] else ()
        labels = called or ([name] if rows.shape[1] == 1 else
                            [f"{name}_{i}" for i in range(rows.shape[1])])  # fmt: skip
        states |= dict(zip(labels, rows.T, strict=True))
    return {"step": np.arange(len(next(iter(states.values())))), **told, **states}


def _flat(space: spaces.Space[Any], value: Any) -> Shaped[np.ndarray, "n d"]:
    """Rows of numbers; the parts of a composite space side by side, in its own order."""
    if isinstance(space, spaces.Dict):
        return np.concatenate([_flat(s, value[key]) for key, s in space.spaces.items()], axis=1)
    if isinstance(space, spaces.Tuple):
        return np.concatenate([_flat(s, v) for s, v in zip(space, value, strict=True)], axis=1)
    if isinstance(space, spaces.Box | spaces.Discrete | spaces.MultiDiscrete | spaces.MultiBinary):
        return np.asarray(value).reshape(len(value), -1)
    raise UserError(f"a space of kind {type(space).__name__} holds no numbers: import another")


def _open(spec: str) -> Any:
    minari = installed_minari()
    from minari.dataset.minari_storage import MinariStorage
    from minari.storage.datasets_root_dir import get_dataset_path

    place = Path(spec) if Path(spec).is_dir() else get_dataset_path(spec)
    data = place / "data" if (place / "data").is_dir() else place
    cure = f"`minari download {spec}` fetches a public one, `minari list local` names what is there"
    if not data.is_dir():
        raise UserError(f"Minari has no dataset {spec!r} on this machine: {cure}")
    try:
        raw = MinariStorage.read_raw_metadata(data)
        if not {"observation_space", "action_space"} <= raw.keys():
            # Minari would run the environment that the file names.
            raise UserError(f"{data} does not say what its observations and actions are: {cure}")
        return minari.MinariDataset(data)
    except (OSError, ValueError, KeyError, AssertionError) as error:
        raise UserError(f"{data} is no Minari dataset ({error}): {cure}") from None

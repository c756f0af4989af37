"""Canonical episodes: what natural human behaviour looked like with one robot.

On disk: one compressed `.npz` without pickle. Its arrays carry the names of the fields below, and
`header` is JSON with everything else, so that `numpy.load` and `json.loads` open it anywhere.
`docs/data-format.md` describes every field.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from jaxtyping import Float, Int
from pydantic import BaseModel, ConfigDict, PositiveFloat

from rigid.data.about import NOTHING_SAID, About
from rigid.data.checks import check_notes, check_task, check_values
from rigid.errors import UserError
from rigid.files import json_text, write_atomically
from rigid.headers import parse_header
from rigid.tasks.protocol import Task

Source = Literal["synthetic", "recorded"]

FORMAT_VERSION = 1
"""What was added since (`rewards`, `times`, `about`) is optional, and old readers pass over it."""

_FLOATS = ("features", "observations", "actions", "returns", "success")
_TOLD = ("rewards", "times")
"""Told on top; never part of `data_hash`."""
_OPTIONAL = ("observations", "actions", *_TOLD)
_TYPES = {"seeds": np.int64, "times": np.float64}
_CURE = "copy the file or record it again"


@dataclass(frozen=True, kw_only=True)
class CanonicalEpisodes:
    """E episodes of T control steps.

    Row t of an episode holds the human's observation and action *before* step t and the features
    of the state that step t led to.
    """

    features: Float[np.ndarray, "E T F"]
    """What naturalness sees (`Task.features`), float32."""
    observations: Float[np.ndarray, "E T H"] | None
    """What the human saw, float32; None where nobody recorded it."""
    actions: Float[np.ndarray, "E T A"] | None
    """What the human did, in [-1, 1], float32; None where nobody recorded it."""
    seeds: Int[np.ndarray, " E"]
    """Seed of each episode's start."""
    returns: Float[np.ndarray, " E"]
    """Undiscounted returns; NaN where unknown."""
    success: Float[np.ndarray, " E"]
    """1 or 0 by the task's criterion; NaN where it defines none."""
    task: Mapping[str, Any]
    """`Task.describe()` of the task they were recorded in."""
    feature_names: tuple[str, ...]
    source: Source
    """Whether the human was a policy or a person."""
    provenance: Mapping[str, Any]
    """Hashes of robot and human, seed, …; never part of `data_hash`."""
    control_period: float = 0.1
    """Time between steps [s]."""
    rewards: Float[np.ndarray, "E T"] | None = None
    """Of each step, float32; None where nobody recorded it."""
    times: Float[np.ndarray, "E T"] | None = None
    """When each row's features were seen, on the recording's own clock [s]; None where unknown."""
    about: About = NOTHING_SAID
    """Units, consent, licence, participants; never part of `data_hash`."""

    def __len__(self) -> int:
        return len(self.features)


class _Header(BaseModel):
    """Everything but the arrays."""

    model_config = ConfigDict(frozen=True, strict=True)

    format: int = FORMAT_VERSION
    task: Mapping[str, Any]
    feature_names: tuple[str, ...]
    source: Source
    provenance: Mapping[str, Any]
    control_period: PositiveFloat
    about: About = NOTHING_SAID


def save_episodes(path: Path | str, episodes: CanonicalEpisodes) -> None:
    """Writes `episodes` to `path` atomically; equal episodes give equal bytes.

    Raises:
        UserError: `load_episodes` would refuse the file.
    """
    path = Path(path)
    check_values(_arrays(episodes), episodes.feature_names, where=path)
    check_notes(episodes.about, len(episodes), where=path)
    buffer = io.BytesIO()
    np.savez_compressed(
        buffer, allow_pickle=False,
        header=np.array(_header_text(episodes, **_told(episodes.about))), **_arrays(episodes),
    )  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, buffer.getvalue())


def load_episodes(path: Path | str, *, task: Task | None) -> CanonicalEpisodes:
    """Reads canonical episodes and checks them against `task`.

    Args:
        path: A file that `save_episodes` wrote.
        task: The task they are meant for; None checks only what can be checked without.

    Raises:
        UserError: The file is missing, truncated, no `.npz` or of a newer format version; its
            arrays disagree in length or hold NaN; or it was recorded in another task.
    """
    path = Path(path)
    arrays = _read_arrays(path)
    if "header" not in arrays:
        raise UserError(f"{path} has no header: record canonical episodes with `rigid record`")
    text = str(arrays["header"])
    header = parse_header(_Header, text, version=FORMAT_VERSION, where=path, cure=_CURE)
    arrays = _typed(arrays, path)
    if task is not None:
        check_task(header.task, header.feature_names, task, where=path)
    check_values(arrays, header.feature_names, where=path, task=task)
    check_notes(header.about, len(arrays["features"]), where=path)
    fields: dict[str, Any] = {**dict.fromkeys(_OPTIONAL), **arrays, **_shared(header)}
    fields["about"] = header.about
    return CanonicalEpisodes(**fields)


def data_hash(episodes: CanonicalEpisodes) -> str:
    """SHA-256 over the episodes and the task they belong to; part of 'same settings'.

    Provenance, `about`, `rewards` and `times` are left out: they say where the numbers come from,
    not what they are.
    """
    digest = hashlib.sha256(_header_text(episodes, provenance={}).encode())
    for name, array in sorted(_arrays(episodes).items()):
        if name in _TOLD:
            continue
        digest.update(f"\0{name} {array.shape}\0".encode())
        digest.update(np.ascontiguousarray(array, array.dtype.newbyteorder("<")).tobytes())
    return digest.hexdigest()


def beside(episodes: CanonicalEpisodes) -> dict[str, Any]:
    """What the header says but for notes on single episodes, for formats with room of their own."""
    about = episodes.about.model_dump(exclude={"episodes"}, exclude_defaults=True)
    text = _header_text(episodes, about=about)
    return dict(json.loads(text))


def _arrays(episodes: CanonicalEpisodes) -> dict[str, np.ndarray]:
    """The arrays by name, in the types they have on disk; absent ones left out."""
    found = {name: getattr(episodes, name) for name in ("seeds", *_FLOATS, *_TOLD)}
    return {
        name: np.asarray(array, _TYPES.get(name, np.float32))
        for name, array in found.items()
        if array is not None
    }


def _header_text(episodes: CanonicalEpisodes, **changes: Any) -> str:
    return json_text({"format": FORMAT_VERSION, **_shared(episodes), **changes})


def _shared(source: CanonicalEpisodes | _Header) -> dict[str, Any]:
    """What header and episodes both hold, by name; `about` aside."""
    names = _Header.model_fields.keys() - {"format", "about"}
    return {name: getattr(source, name) for name in names}


def _told(about: About) -> dict[str, Any]:
    """`about` as the header has it; no entry where nothing was said, as in older files."""
    said = about.model_dump(exclude_defaults=True)
    return {"about": said} if said else {}


def _read_arrays(path: Path) -> dict[str, np.ndarray]:
    try:
        with path.open("rb") as file:
            is_zip = file.read(4) == b"PK\x03\x04"
            file.seek(0)
            if not is_zip:
                raise UserError(
                    f"{path} is no .npz file: record one with `rigid record`, or make one of your "
                    "data with `rigid data import`"
                )
            with np.load(file, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
    except FileNotFoundError:
        raise UserError(f"{path} does not exist: record it with `rigid record`") from None
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, RuntimeError) as error:
        # RuntimeError: a damaged flag claims encryption or an unknown compression.
        raise UserError(f"{path} is truncated or cannot be read ({error}): {_CURE}") from None
    except ValueError as error:  # An array of objects, as NumPy makes from ragged lists.
        raise UserError(
            f"{path} holds something else than arrays of numbers ({error}): "
            "give every episode the same number of steps"
        ) from None


def _typed(arrays: dict[str, np.ndarray], path: Path) -> dict[str, np.ndarray]:
    """The arrays that episodes are made of, in their types in memory."""
    typed = {}
    for name in ("seeds", *_FLOATS, *_TOLD):
        if name not in arrays and name in _OPTIONAL:
            continue
        if name not in arrays:
            raise UserError(f"{path} has no {name!r}: {_CURE}")
        if arrays[name].dtype.kind not in ("iu" if name == "seeds" else "iuf"):
            raise UserError(f"{path}: {name} are {arrays[name].dtype}, no numbers: {_CURE}")
        with np.errstate(over="ignore"):  # What float32 cannot hold becomes inf, and is refused.
            typed[name] = arrays[name].astype(_TYPES.get(name, np.float32))
    return typed

"""The referees that judged, on disk: whoever has them and episodes of a human can judge again.

For each adversary `ID.safetensors` holds the arrays and `ID.json` what they mean: at each level and
for each fold the view and the layers, and for each κ the false alarms on held-out canonical data.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import jax.numpy as jnp
import numpy as np
from pydantic import BaseModel, ConfigDict, NonNegativeFloat, PositiveInt
from safetensors import SafetensorError
from safetensors.numpy import load, save

from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically
from rigid.headers import parse_header
from rigid.naturalness.panel import Jury, Panel, naturalness
from rigid.naturalness.rates import Rate
from rigid.naturalness.referee import Referee
from rigid.naturalness.standardise import Scale
from rigid.naturalness.views import Episodes

FORMAT_VERSION = 1
_CURE = "copy the run directory again, or measure again"


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, strict=True, allow_inf_nan=False)


class _Alarms(_Part):
    """Share of canonical windows taken for the adversary's."""

    kappa: float
    value: NonNegativeFloat
    se: NonNegativeFloat | None


class _Referee(_Part):
    view: Literal["flat", "summary"]
    layers: int


class _Jury(_Part):
    length: PositiveInt
    referees: tuple[_Referee, ...]
    alarms: tuple[_Alarms, ...]


class _Card(_Part):
    format: int = FORMAT_VERSION
    feature_names: tuple[str, ...]
    levels: Mapping[Literal["step", "window16"], _Jury]


def save_panel(directory: Path, name: str, panel: Panel, feature_names: Sequence[str]) -> None:
    """Writes the referees of one adversary as `NAME.safetensors` and `NAME.json`."""
    arrays: dict[str, np.ndarray] = {}
    levels = {}
    for level, jury in panel.items():
        for number, referee in enumerate(jury.referees):
            named = _arrays(referee)
            arrays |= {f"{level}/{number}/{part}": array for part, array in named.items()}
        levels[level] = {
            "length": jury.referees[0].length,
            "referees": [{"view": r.view, "layers": len(r.network)} for r in jury.referees],
            "alarms": [{"kappa": kappa, **rate._asdict()} for kappa, rate in jury.alarms.items()],
        }
    card = {"format": FORMAT_VERSION, "feature_names": list(feature_names), "levels": levels}
    directory.mkdir(parents=True, exist_ok=True)
    write_atomically(directory / f"{name}.safetensors", save(arrays))
    write_atomically(directory / f"{name}.json", json_text(card, indent=1).encode())


def load_panel(directory: Path, name: str) -> Panel:
    """The referees that judged one adversary.

    Raises:
        UserError: A file is missing, damaged or of a newer format version.
    """
    place = directory / f"{name}.json"
    card = parse_header(
        _Card, read_bytes(place, cure=_CURE), version=FORMAT_VERSION, where=place, cure=_CURE
    )
    place = directory / f"{name}.safetensors"
    try:
        arrays = load(read_bytes(place, cure=_CURE))
        return {level: _jury(arrays, level, jury) for level, jury in card.levels.items()}
    except SafetensorError as error:
        raise UserError(f"{place} is damaged ({error}): {_CURE}") from None
    except KeyError as error:
        raise UserError(f"{place} has no {error}, which its card promises: {_CURE}") from None


def rejudge(directory: Path, name: str, episodes: Episodes) -> dict[str, Rate | None]:
    """Naturalness of `episodes` by the referees that judged an adversary, at every level.

    Args:
        directory: `referee` in a run directory.
        name: Id of the adversary.
        episodes: Fresh episodes of that adversary; of another human this is only an upper bound.

    Raises:
        UserError: The stored referees cannot be read.
    """
    return naturalness(load_panel(directory, name), episodes)


def _arrays(referee: Referee) -> dict[str, np.ndarray]:
    named: dict[str, Any] = {f"scale/{part}": a for part, a in referee.scale._asdict().items()}
    for number, layer in enumerate(referee.network):
        named |= {f"layer{number}/{part}": array for part, array in layer.items()}
    return {part: np.asarray(array, order="C") for part, array in named.items()}


def _jury(arrays: Mapping[str, np.ndarray], level: str, jury: _Jury) -> Jury:
    referees = tuple(
        _referee(arrays, f"{level}/{number}", found, jury.length)
        for number, found in enumerate(jury.referees)
    )
    return Jury(referees, {found.kappa: Rate(found.value, found.se) for found in jury.alarms})


def _referee(
    arrays: Mapping[str, np.ndarray], prefix: str, found: _Referee, length: int
) -> Referee:
    network = [
        {part: jnp.asarray(arrays[f"{prefix}/layer{number}/{part}"]) for part in ("w", "b")}
        for number in range(found.layers)
    ]
    scale = Scale(*(arrays[f"{prefix}/scale/{part}"] for part in Scale._fields))
    return Referee(network, scale, length, found.view)

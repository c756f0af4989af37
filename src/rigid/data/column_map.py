"""How the columns of somebody's recording become those that a task knows: `--map FILE`.

A map is JSON or YAML: for each name that RIGID knows, the name that the recording has, or an object
that also says how to convert its numbers.

    {"time": {"from": "t_ms", "unit": "ms"}, "elbow": {"from": "ElbowFlexion", "unit": "deg"},
     "itch_forearm": {"from": "target", "equals": "forearm"}, "participant": "subject"}
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError, model_validator

from rigid.errors import UserError
from rigid.files import read_bytes

_TURN = math.pi / 180
UNITS: Mapping[str, tuple[str, float]] = {
    "rad": ("rad", 1.0), "deg": ("rad", _TURN),
    "rad/s": ("rad/s", 1.0), "deg/s": ("rad/s", _TURN),
    "s": ("s", 1.0), "ms": ("s", 1e-3), "us": ("s", 1e-6), "ns": ("s", 1e-9),
    "m": ("m", 1.0), "cm": ("m", 1e-2), "mm": ("m", 1e-3),
    "m/s": ("m/s", 1.0), "cm/s": ("m/s", 1e-2), "mm/s": ("m/s", 1e-3),
    "N": ("N", 1.0),
}  # fmt: skip
"""Each unit as a multiple of the one that tasks measure in."""


class Column(BaseModel):
    """Where the numbers of a column come from: times `scale`, plus `offset`, in `unit`."""

    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)

    source: str | None = Field(default=None, alias="from")
    """Column of the recording."""
    value: float | None = None
    """The same number everywhere, in place of a column."""
    equals: str | None = None
    """1 where the column holds this text, else 0; unknown where it is empty."""
    unit: str | None = None
    """What the column is measured in, one of `UNITS`; converted to what tasks measure in."""
    scale: float = 1.0
    offset: float = 0.0

    @model_validator(mode="after")
    def _sound(self) -> Column:
        if (self.source is None) == (self.value is None):
            raise ValueError('give either "from" (a column) or "value" (a number)')
        if self.unit is not None and self.unit not in UNITS:
            raise ValueError(f"unit {self.unit!r} is unknown, known are {', '.join(UNITS)}")
        beside = sorted({"value", "unit", "scale", "offset"} & self.model_fields_set)
        if self.equals is not None and beside:
            raise ValueError(f'"equals" gives 1 or 0, so leave "{beside[0]}" out')
        return self

    @property
    def measured_in(self) -> str | None:
        """The unit of the numbers after their conversion; None where nobody said."""
        return None if self.unit is None else UNITS[self.unit][0]

    @property
    def factor(self) -> float:
        """On the numbers of the recording."""
        return self.scale * (1.0 if self.unit is None else UNITS[self.unit][1])


ColumnMap = Mapping[str, Column]
"""By the name that RIGID knows."""

_CURE = "docs/canonical-data.md shows one"
_COLUMNS: TypeAdapter[dict[str, Column]] = TypeAdapter(dict[str, Column])


def load_map(path: Path | None) -> ColumnMap:
    """Reads a map; no file, no changes.

    Raises:
        UserError: It is missing, no map, or names an unknown unit.
    """
    if path is None:
        return {}
    found = _parsed(path, read_bytes(path, cure=_CURE))
    if not isinstance(found, dict):
        raise UserError(f"{path} is no map from names to columns: {_CURE}")
    named = {str(name): {"from": entry} if isinstance(entry, str) else entry
             for name, entry in found.items()}  # fmt: skip
    try:
        return _COLUMNS.validate_python(named)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        said = first["msg"].removeprefix("Value error, ")
        raise UserError(f"{path}: {place}: {said}; {_CURE}") from None


def _parsed(path: Path, data: bytes) -> Any:
    try:
        text = data.decode(json.detect_encoding(data))  # As JSON has it, also of Windows.
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:
        raise UserError(f"{path} is no text, but --map takes a JSON or YAML file: {_CURE}")
    if path.suffix.lower() in {".yaml", ".yml"}:
        try:
            return yaml.safe_load(text)
        except yaml.YAMLError as error:
            said = " ".join(str(error).split())
            raise UserError(f"{path} is no YAML ({said})") from None
    try:
        return json.loads(text)
    except ValueError as error:
        raise UserError(f"{path} is no JSON ({error}): mind quotes and commas") from None

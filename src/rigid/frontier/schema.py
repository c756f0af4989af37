"""Schema 1 of `frontier.json`, as far as RIGID relies on it in a file of someone else."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, NonNegativeFloat, NonNegativeInt, PositiveInt

Share = Annotated[float, Field(ge=0, le=1)]
_Ends = tuple[float, float] | None
_Seed = Annotated[str, Field(pattern=r"^\d+$")]


class _Part(BaseModel):
    """Unknown fields are allowed: the schema grows by adding."""

    model_config = ConfigDict(extra="allow", allow_inf_nan=False)


class CanonicalBlock(_Part):
    """Canonical play: the anchor of every curve."""

    success: Share | None
    return_: float = Field(alias="return")
    adversarialness: Share
    episodes: PositiveInt
    source: str


class PointBlock(_Part):
    """One adversary after re-scoring."""

    id: str
    seed: NonNegativeInt
    round: PositiveInt
    lambda_: NonNegativeFloat | Literal["inf"] = Field(alias="lambda")
    naturalness: Share
    naturalness_own: Share | None
    naturalness_all: dict[str, Share | None]
    adversarialness: Share | None
    return_: float | None = Field(alias="return")
    success: Share | None
    episodes: PositiveInt
    outcomes: dict[str, Share | None]
    peak_force: float | None
    impulse: float | None
    faults: NonNegativeInt
    converged: bool
    on_frontier: bool


class RangeBlock(_Part):
    """The file of a calibrated range."""

    name: str
    sha256: str


class FrontierFile(_Part):
    """The whole file."""

    schema_: Literal[1] = Field(alias="schema")
    task: str
    robot: str
    preset: str
    canonical: CanonicalBlock
    points: list[PointBlock]
    worst_at: dict[str, Share]
    worst_at_interval: dict[str, _Ends]
    auc_natural: Share
    auc: Share
    auc_interval: _Ends
    auc_by_seed: Annotated[dict[_Seed, Share], Field(min_length=1)]
    return_range: tuple[float, float]
    range_source: str | None = None
    range_file: RangeBlock | None = None
    env_steps: NonNegativeInt
    core_seconds: NonNegativeFloat
    wall_seconds: NonNegativeFloat

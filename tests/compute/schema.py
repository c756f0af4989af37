"""Schema 1 of `frontier.json`, written down once more from the contract, not from the code."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, NonNegativeFloat, NonNegativeInt, PositiveInt

Share = Annotated[float, Field(ge=0, le=1)]
Ends = tuple[Share, Share] | None
Levels = Literal["0.8", "0.9", "0.95"]


class _Part(BaseModel):
    """Every field has to be there, with its type; more are allowed."""

    model_config = ConfigDict(strict=True, extra="allow", allow_inf_nan=False)


class Canonical(_Part):
    success: Share | None
    return_: float = Field(alias="return")
    adversarialness: Share
    episodes: PositiveInt
    source: Literal["synthetic", "recorded"]


class NaturalnessAll(_Part):
    step_k1: Share | None
    step_k4: Share | None
    window16_k1: Share | None
    window16_k4: Share | None
    window16_k16: Share | None


class Point(_Part):
    id: Annotated[str, Field(pattern=r"^s\d+-r\d+-l\d+$")]
    seed: NonNegativeInt
    round: PositiveInt
    lambda_: NonNegativeFloat | Literal["inf"] = Field(alias="lambda")
    naturalness: Share
    naturalness_own: Share | None
    naturalness_all: NaturalnessAll
    adversarialness: Share | None
    return_: float | None = Field(alias="return")
    success: Share | None
    episodes: PositiveInt
    env_steps: PositiveInt
    outcomes: dict[str, Share | None]
    peak_force: NonNegativeFloat | None
    impulse: NonNegativeFloat | None
    faults: NonNegativeInt
    converged: bool
    on_frontier: bool


class FrontierFile(_Part):
    schema_: Literal[1] = Field(alias="schema")
    task: str
    robot: str
    preset: str
    canonical: Canonical
    points: list[Point]
    worst_at: dict[Levels, Share]
    worst_at_interval: dict[Levels, Ends]
    auc_natural: Share
    auc: Share
    auc_interval: Ends
    auc_by_seed: dict[Annotated[str, Field(pattern=r"^\d+$")], Share]
    auc_pooled: Share
    auc_staircase: Share
    auc_linear: Share
    auc_excess: Share
    auc_paper_axis: Share | None
    return_range: tuple[float, float]
    range_source: str
    env_steps: PositiveInt
    env_steps_scoring: PositiveInt
    core_seconds: NonNegativeFloat
    wall_seconds: NonNegativeFloat

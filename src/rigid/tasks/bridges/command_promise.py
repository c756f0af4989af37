"""What a program that serves a task says of it, in the handshake."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from rigid.serving.session import Counts, Promise, Size
from rigid.tasks.protocol import AgentSpec

_Names = tuple[Annotated[str, Field(max_length=200)], ...]


class PlayerPromise(BaseModel):
    """What a program says of one player."""

    model_config = ConfigDict(frozen=True)

    observation_size: Size
    action_size: Size
    choices: Counts
    observation_names: _Names

    @model_validator(mode="after")
    def _fits(self) -> PlayerPromise:
        if self.observation_names and len(self.observation_names) != self.observation_size:
            raise ValueError(
                f"there are {len(self.observation_names)} observation_names for "
                f"{self.observation_size} numbers"
            )
        if self.choices and sum(self.choices) != self.action_size:
            raise ValueError(f"choices {self.choices} do not add up to {self.action_size}")
        return self

    def spec(self) -> AgentSpec:
        """The same, as a task says it."""
        return AgentSpec(
            self.observation_size, self.action_size, self.observation_names, self.choices
        )


class TaskPromise(Promise):
    """What a program that serves a task says of itself."""

    serves: Literal["task"]
    horizon: Annotated[int, Field(ge=1, le=1_000_000)]
    robot: PlayerPromise
    human: PlayerPromise
    feature_names: _Names
    feature_units: dict[str, str]
    return_range: tuple[float, float] | None
    control_period: Annotated[float, Field(gt=0, allow_inf_nan=False)]

    @property
    def seen_names(self) -> tuple[str, ...]:
        """Of what naturalness sees: the features, or what the human observes and does."""
        if self.feature_names:
            return self.feature_names
        human = self.human
        seen = human.observation_names or _numbered("observation", human.observation_size)
        return (*seen, *_numbered("action", human.action_size))

    @model_validator(mode="after")
    def _fits(self) -> TaskPromise:
        if len(set(self.feature_names)) != len(self.feature_names):
            raise ValueError("feature_names names one twice")
        ends = self.return_range
        if ends is not None and not (np.isfinite(ends).all() and ends[0] < ends[1]):
            raise ValueError(f"return_range must be (worst, best) with worst < best, got {ends}")
        return self


def _numbered(kind: str, count: int) -> tuple[str, ...]:
    return tuple(f"{kind}_{number}" for number in range(count))

"""One environment of somebody else's as two players: what every kind of bridge reduces to."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Float32

from rigid.errors import UserError
from rigid.tasks.protocol import AgentSpec


class Glimpse(NamedTuple):
    """What one environment said after a reset or a step."""

    robot: Float32[np.ndarray, " r"]
    """The robot's observation."""
    human: Float32[np.ndarray, " h"]
    features: Float32[np.ndarray, " f"]
    """What naturalness sees of the human in this step."""
    reward: float
    """Of the robot's side; 0 after a reset."""
    ended: bool
    """Whether the episode is over."""
    success: float
    """1 or 0 as the environment has it so far; NaN where it says nothing."""


@runtime_checkable
class Playable(Protocol):
    """One environment with two players."""

    def reset(self, seed: int) -> Glimpse:
        """Begins the episode of this seed."""
        ...

    def step(self, robot: Float[np.ndarray, " a_r"], human: Float[np.ndarray, " a_h"]) -> Glimpse:
        """One control step; actions in [-1, 1]."""
        ...


class Rules(NamedTuple):
    """What a task needs to know of an environment."""

    robot: AgentSpec
    human: AgentSpec
    feature_names: tuple[str, ...]
    horizon: int
    control_period: float
    """[s]."""


Opener = Callable[[], Playable]
"""Opens one more environment of the task, in this process or in another: it must be picklable."""

_WITHIN = ("unwrapped", "aec_env", "par_env", "env", "single_agent_env")
"""Where wrappers of PettingZoo, Gymnasium and MaMuJoCo keep what they wrap."""
_LIMITS = ("max_cycles", "_max_episode_steps", "max_steps")
_DEPTH = 4


def horizon_of(env: Any, given: int | None, name: str) -> int:
    """Steps of an episode: what the user says, else the environment's own limit.

    Raises:
        UserError: Nobody says, or less than 1.
    """
    if given is not None:
        if given < 1:
            raise UserError(f"{name}: horizon is {given}, but an episode has at least 1 step")
        return given
    for part in _parts(env):
        limits = [getattr(getattr(part, "spec", None), "max_episode_steps", None)]
        limits += [getattr(part, limit, None) for limit in _LIMITS]
        for limit in limits:
            if isinstance(limit, int | np.integer) and limit > 0:
                return int(limit)
    raise UserError(
        f"{name}: the environment does not say how long an episode is (no max_cycles, no "
        "spec.max_episode_steps): say it with --horizon STEPS"
    )


def period_of(env: Any) -> float:
    """Seconds of a control step: one frame of the environment's `render_fps`; 0.1 by default."""
    fps = (getattr(env, "metadata", None) or {}).get("render_fps")
    return 1 / float(fps) if isinstance(fps, int | float) and fps > 0 else 0.1


def success_in(infos: Iterator[Mapping[str, Any]]) -> float:
    """1 or 0 as the first info says that knows (`is_success`, `success`); NaN where none does.

    Raises:
        ValueError: It is neither 0, 1 nor NaN: nobody could say what it is a share of.
    """
    for info in infos:
        for name in ("is_success", "success"):
            if name in info:
                found = float(info[name])
                if found not in {0.0, 1.0} and not np.isnan(found):
                    raise ValueError(f"info has {name} {info[name]!r}, but must have 0 or 1")
                return found
    return float("nan")


def _parts(env: Any) -> Iterator[Any]:
    """The environment and what it wraps, outermost first."""
    layer, seen = [env], set[int]()
    for _ in range(_DEPTH):
        inner: list[Any] = []
        for part in layer:
            if id(part) not in seen:
                seen.add(id(part))
                yield part
                inner += [getattr(part, name, None) for name in _WITHIN]
        layer = [part for part in inner if part is not None]

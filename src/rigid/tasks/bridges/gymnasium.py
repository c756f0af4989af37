"""`gymnasium:MODULE:FACTORY`: environments with one agent, the robot, in which a person lives.

Such an environment moves its person by itself. RIGID has to move them instead, and needs to see how
they move: a `HumanPort` says how. The environment's own agent is the robot, and its reward is the
task's.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from jaxtyping import Float, Float32

from rigid.errors import UserError
from rigid.factories import call_factory, source_fingerprint, told
from rigid.tasks.bridges.once import warn_once
from rigid.tasks.bridges.playing import Glimpse, Rules, horizon_of, period_of, success_in
from rigid.tasks.bridges.spaces import deed_of, sight_of
from rigid.tasks.bridges.task import BridgeTask
from rigid.tasks.protocol import AgentSpec

PREFIX = "gymnasium:"
_MEMBERS = ("human_action_space", "apply_human_action", "human_features")
_FORM = (
    "give an environment with human_action_space, apply_human_action(action) and "
    "human_features(), or a rigid.tasks.bridges.HumanPort (docs/tasks.md)"
)


@dataclass(frozen=True, kw_only=True)
class HumanPort:
    """How the person in an environment is moved and seen.

    An environment that has `human_action_space`, `apply_human_action(action)`, `human_features()`
    and perhaps `human_observation()` needs none: they are found there.
    """

    env: gymnasium.Env[Any, Any]
    actions: int | gymnasium.Space[Any]
    """What the person does: an action space, or how many reals in [-1, 1]."""
    apply: Callable[[Any], None]
    """Is given the person's action before each step of the environment."""
    features: Callable[[], Any]
    """What naturalness sees of the person, after a reset and each step: numbers in a row, or a
    dictionary of numbers by name, always the same ones. Never the robot, never contact."""
    observe: Callable[[], Any] | None = None
    """What the person sees, numbers in a row; by default the features, which are how they move
    themselves, and then what the robot sees."""


def gymnasium_task(name: str, *, horizon: int | None = None) -> BridgeTask:
    """The task of a Gymnasium environment with a person inside.

    Args:
        name: `gymnasium:MODULE:FACTORY`. `FACTORY()` returns a `HumanPort`, or an environment with
            the members that are listed there.
        horizon: Steps of an episode; by default the environment's own limit.

    Raises:
        UserError: There is no such environment or horizon, or a space is not supported.
    """
    opener = _Opener(name, str(Path.cwd()))
    player = opener()
    rules = Rules(
        robot=player.robot,
        human=player.human,
        feature_names=player.feature_names,
        horizon=horizon_of(player.env, horizon, name),
        control_period=period_of(player.env),
    )
    version = source_fingerprint(name, opener.folder)
    return BridgeTask(name, {"horizon": rules.horizon}, opener, rules, version)


@dataclass(frozen=True)
class _Opener:
    """Opens the environment in any process that can import the factory."""

    name: str
    folder: str

    def __call__(self) -> _Inhabited:
        warn_once()
        return _Inhabited(_port(call_factory(self.name, self.folder), self.name), self.name)


class _Inhabited:
    """One environment as robot and human."""

    def __init__(self, port: HumanPort, name: str) -> None:
        self.env, self._port = port.env, port
        space = _space(port.actions, name)
        self._sight = sight_of(self.env.observation_space, f"the robot of {name}")
        self._deed = deed_of(self.env.action_space, f"the robot of {name}")
        self._moves = deed_of(space, f"the human of {name}")
        self.robot = AgentSpec(
            self._sight.size, self._deed.size, self._sight.names, self._deed.choices
        )
        try:
            observation, _ = self.env.reset(seed=0)
            self.feature_names = _feature_names(port.features())
            seen = self._human_sees(self._sight.row(observation), self._features())
        except Exception as error:  # noqa: BLE001 - Somebody else's code may raise anything.
            raise UserError(f"{name}: the first reset fails: {told(error)}") from None
        self.human = AgentSpec(
            len(seen), self._moves.size, self._human_names(len(seen)), self._moves.choices
        )

    def reset(self, seed: int) -> Glimpse:
        """Begins the episode of this seed."""
        observation, info = self.env.reset(seed=seed)
        return self._glimpse(observation, 0.0, info, ended=False)

    def step(self, robot: Float[np.ndarray, " a_r"], human: Float[np.ndarray, " a_h"]) -> Glimpse:
        """One control step: the person's action is applied, then the robot's."""
        self._port.apply(self._moves.action(human))
        found = self.env.step(self._deed.action(robot))
        observation, reward, terminated, truncated, info = found
        return self._glimpse(
            observation, float(reward), info, ended=bool(terminated) or bool(truncated)
        )

    def _glimpse(
        self, observation: Any, reward: float, info: Mapping[str, Any], *, ended: bool
    ) -> Glimpse:
        seen, features = self._sight.row(observation), self._features()
        success = success_in(iter([info]))
        human = self._human_sees(seen, features)
        return Glimpse(seen, human, features, reward, ended, success)

    def _features(self) -> Float32[np.ndarray, " f"]:
        """By the names of the first reset, whatever their order is now."""
        found = self._port.features()
        if isinstance(found, Mapping):
            named = {str(name): value for name, value in found.items()}
            if set(named) != set(self.feature_names):
                raise ValueError(
                    f"human features are {', '.join(named)}, but were "
                    f"{', '.join(self.feature_names)} at the first reset"
                )
            found = [named[name] for name in self.feature_names]
        return _row(found)

    def _human_sees(self, robot: np.ndarray, features: np.ndarray) -> Float32[np.ndarray, " h"]:
        if self._port.observe is not None:
            return _row(self._port.observe())
        return np.concatenate([features, robot])

    def _human_names(self, size: int) -> tuple[str, ...]:
        if self._port.observe is None:
            return (*self.feature_names, *(f"robot/{name}" for name in self._sight.names))
        return tuple(f"observation_{number}" for number in range(size))


def _port(made: Any, name: str) -> HumanPort:
    """The port that a factory gave, or that of the environment that it gave."""
    if isinstance(made, HumanPort):
        return made
    if not isinstance(made, gymnasium.Env):
        raise UserError(f"{name} gives a {type(made).__name__}: {_FORM}")
    inner: Any = made.unwrapped
    for member in _MEMBERS:
        if not hasattr(inner, member):
            raise UserError(
                f"{name}: RIGID cannot move the person in {type(inner).__name__}, which has no "
                f"{member}: {_FORM}"
            )
    return HumanPort(
        env=made,
        actions=inner.human_action_space,
        apply=inner.apply_human_action,
        features=inner.human_features,
        observe=getattr(inner, "human_observation", None),
    )


def _space(actions: int | gymnasium.Space[Any], name: str) -> gymnasium.Space[Any]:
    if isinstance(actions, gymnasium.Space):
        return actions
    if isinstance(actions, bool) or actions < 1:
        raise UserError(f"{name}: the human's actions are {actions!r}, but must be 1 or more")
    return spaces.Box(-1.0, 1.0, (actions,))


def _feature_names(features: Any) -> tuple[str, ...]:
    if isinstance(features, Mapping):
        return tuple(map(str, features))
    return tuple(f"feature_{number}" for number in range(len(_row(features))))


def _row(numbers: Any) -> Float32[np.ndarray, " n"]:
    return np.asarray(numbers, dtype=np.float32).reshape(-1)

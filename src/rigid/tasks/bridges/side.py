"""One side of a PettingZoo environment: agents that see and act as one."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from itertools import accumulate, pairwise
from typing import Any

import gymnasium
import numpy as np
from jaxtyping import Float, Float32

from rigid.tasks.bridges.agents import agents_of
from rigid.tasks.bridges.spaces import Deed, Sight, deed_of, sight_of
from rigid.tasks.protocol import AgentSpec


class Side:
    """Agents of an environment that act as one."""

    def __init__(self, env: Any, agents: Sequence[str]) -> None:
        self.agents = tuple(agent for agent in agents_of(env) if str(agent) in agents)
        self._sights: dict[Any, Sight] = {}
        self._deeds: dict[Any, Deed] = {}
        for agent in self.agents:
            self._sights[agent] = sight_of(_observation_space(env, agent), f"agent {agent!r}")
            self._deeds[agent] = deed_of(env.action_space(agent), f"agent {agent!r}")
        ends = accumulate(deed.size for deed in self._deeds.values())
        self._bounds = tuple(pairwise((0, *ends)))

    @property
    def spec(self) -> AgentSpec:
        """What the side sees and does."""
        deeds = tuple(self._deeds.values())
        discrete = all(deed.choices for deed in deeds)
        names = self._named({agent: sight.names for agent, sight in self._sights.items()})
        return AgentSpec(
            observation_size=len(names),
            action_size=sum(deed.size for deed in deeds),
            observation_names=names,
            choices=tuple(n for deed in deeds for n in deed.choices) if discrete else (),
        )

    @property
    def feature_names(self) -> tuple[str, ...]:
        """Of what the side sees, then of what it does."""
        deeds = {
            agent: tuple(f"action_{number}" for number in range(deed.size))
            for agent, deed in self._deeds.items()
        }
        return self.spec.observation_names + self._named(deeds)

    def seen(
        self, observations: Mapping[Any, Any], before: Float32[np.ndarray, " o"] | None
    ) -> Float32[np.ndarray, " o"]:
        """What the side sees; agents that have left see what they last saw."""
        rows, start = [], 0
        for agent, sight in self._sights.items():
            if agent in observations:
                rows.append(sight.row(observations[agent]))
            else:
                assert before is not None
                rows.append(before[start : start + sight.size])
            start += sight.size
        return np.concatenate(rows)

    def actions(self, row: Float[np.ndarray, " a"]) -> dict[Any, Any]:
        """Each agent's action, in the environment's terms."""
        return {
            agent: deed.action(part)
            for (agent, deed), part in zip(self._deeds.items(), self._parts(row), strict=True)
        }

    def shown(self, row: Float[np.ndarray, " a"]) -> Float32[np.ndarray, " a"]:
        """The actions as an onlooker sees them."""
        deeds, parts = self._deeds.values(), self._parts(row)
        return np.concatenate([deed.shown(part) for deed, part in zip(deeds, parts, strict=True)])

    def _parts(self, row: np.ndarray) -> list[np.ndarray]:
        return [row[start:end] for start, end in self._bounds]

    def _named(self, names: Mapping[Any, tuple[str, ...]]) -> tuple[str, ...]:
        if len(names) == 1:
            return next(iter(names.values()))
        return tuple(f"{agent}/{name}" for agent, each in names.items() for name in each)


def _observation_space(env: Any, agent: Any) -> gymnasium.Space[Any]:
    """What `agent` sees; where the environment does not say so, an array as large as its first."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # PettingZoo's, that there is none.
            space: gymnasium.Space[Any] = env.observation_space(agent)
    except (AttributeError, KeyError, NotImplementedError):  # How PettingZoo says it has none.
        observations, _ = env.reset(seed=0)
        shape = np.shape(observations[agent])
        return gymnasium.spaces.Box(-np.inf, np.inf, shape)
    return space

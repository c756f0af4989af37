"""`pettingzoo:MODULE:FACTORY`: environments of PettingZoo, their agents divided into two sides.

Each side may have several agents: what they see and do is joined, in the environment's order. The
task's reward is the *robot's*, the sum over the agents of its side. Rewards of the human's agents
are left out, since the adversary has another aim. An episode is over as soon as one of the agents
is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from jaxtyping import Float
from pettingzoo import AECEnv
from pettingzoo.utils import aec_to_parallel

from rigid.errors import UserError
from rigid.factories import call_factory, source_fingerprint
from rigid.tasks.bridges.agents import checked_agents, divided
from rigid.tasks.bridges.once import warn_once
from rigid.tasks.bridges.playing import Glimpse, Rules, horizon_of, period_of, success_in
from rigid.tasks.bridges.side import Side
from rigid.tasks.bridges.task import BridgeTask

PREFIX = "pettingzoo:"
_METHODS = ("reset", "step", "observation_space", "action_space")


def pettingzoo_task(
    name: str,
    *,
    human_agent: str | None = None,
    robot_agent: str | None = None,
    horizon: int | None = None,
) -> BridgeTask:
    """The task of a PettingZoo environment.

    Naturalness sees what the human's agents saw before a step and what they then did. Of a discrete
    action that is the choice, not the scores by which it was chosen.

    Args:
        name: `pettingzoo:MODULE:FACTORY`. `FACTORY()` returns a `ParallelEnv`, or an `AECEnv` that
            declares itself `is_parallelizable`.
        human_agent: Agents of the human, separated by commas; by default the one called `human`, or
            all that `robot_agent` leaves.
        robot_agent: Those of the robot; by default the one called `robot`, or all that
            `human_agent` leaves.
        horizon: Steps of an episode; by default the environment's own limit.

    Raises:
        UserError: There is no such environment, agent or horizon, or a space is not supported.
    """
    folder = str(Path.cwd())
    env = _opened(name, folder)
    agents = checked_agents(env, name)
    human, robot = divided(agents, human_agent, robot_agent, name)
    opener = _Opener(name, folder, human, robot)
    try:
        sides = Side(env, robot), Side(env, human)
    except UserError as error:
        raise UserError(f"{name}: {error}") from None
    rules = Rules(
        robot=sides[0].spec,
        human=sides[1].spec,
        feature_names=sides[1].feature_names,
        horizon=horizon_of(env, horizon, name),
        control_period=period_of(env),
    )
    parameters = {
        "human_agent": ",".join(human), "robot_agent": ",".join(robot), "horizon": rules.horizon,
    }  # fmt: skip
    return BridgeTask(name, parameters, opener, rules, source_fingerprint(name, folder))


@dataclass(frozen=True)
class _Opener:
    """Opens the environment in any process that can import the factory."""

    name: str
    folder: str
    human: tuple[str, ...]
    robot: tuple[str, ...]

    def __call__(self) -> _TwoSides:
        env = _opened(self.name, self.folder)
        checked_agents(env, self.name)  # Some only say after a reset who their agents are.
        return _TwoSides(self.name, env, self.robot, self.human)


class _TwoSides:
    """One environment as robot and human."""

    def __init__(self, name: str, env: Any, robot: Sequence[str], human: Sequence[str]) -> None:
        self._name, self._env = name, env
        self._robot, self._human = Side(env, robot), Side(env, human)
        self._everybody = {*self._robot.agents, *self._human.agents}
        self._seen: tuple[np.ndarray, np.ndarray] | None = None

    def reset(self, seed: int) -> Glimpse:
        """Begins the episode of this seed."""
        observations, infos = self._env.reset(seed=seed)
        for agent in self._everybody - set(observations):
            raise UserError(
                f"{self._name}: after a reset the environment shows nothing to {agent!r}: all its "
                "agents must be there from the beginning"
            )
        seen = self._robot.seen(observations, None), self._human.seen(observations, None)
        self._seen = seen
        nothing = np.zeros(self._human.spec.action_size, np.float32)
        features = np.concatenate([seen[1], nothing])
        return Glimpse(*seen, features, 0.0, ended=False, success=self._success(infos))

    def step(self, robot: Float[np.ndarray, " a_r"], human: Float[np.ndarray, " a_h"]) -> Glimpse:
        """One control step."""
        assert self._seen is not None
        before = self._seen
        actions = {**self._robot.actions(robot), **self._human.actions(human)}
        observations, rewards, terminations, truncations, infos = self._env.step(actions)
        seen = (
            self._robot.seen(observations, before[0]), self._human.seen(observations, before[1]),
        )  # fmt: skip
        self._seen = seen
        over = any(terminations.values()) or any(truncations.values())
        return Glimpse(
            *seen,
            features=np.concatenate([before[1], self._human.shown(human)]),
            reward=float(sum(rewards.get(agent, 0.0) for agent in self._robot.agents)),
            ended=over or not self._everybody <= set(self._env.agents),
            success=self._success(infos),
        )

    def _success(self, infos: Mapping[Any, Any]) -> float:
        return success_in(infos.get(agent) or {} for agent in self._robot.agents)


def _opened(name: str, folder: str) -> Any:
    """The environment, as one in which all agents act at the same time."""
    warn_once()
    env = call_factory(name, folder)
    if isinstance(env, AECEnv):
        if not env.metadata.get("is_parallelizable", False):
            raise UserError(
                f"{name} gives an AECEnv whose agents take turns, but in RIGID both act at once: "
                "give its parallel_env, or set is_parallelizable in its metadata where the world "
                "only moves after all have acted"
            )
        return aec_to_parallel(env)
    if isinstance(env, gymnasium.Env):
        raise UserError(
            f"{name} gives an environment of Gymnasium, which has one agent: name it as "
            f"gymnasium:{name.removeprefix(PREFIX)} (docs/tasks.md says how its human acts)"
        )
    lacking = [method for method in _METHODS if not callable(getattr(env, method, None))]
    if lacking:
        raise UserError(
            f"{name} gives a {type(env).__name__} without {lacking[0]}(), but must give a "
            "PettingZoo ParallelEnv"
        )
    return env

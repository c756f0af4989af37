"""Both players of a task as a PettingZoo parallel environment."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.spaces import Box
from pettingzoo import ParallelEnv

from rigid.tasks.protocol import Task
from rigid.tasks.views.single import AGENTS, SingleWorld

PerAgent = dict[str, Any]


class TwoPlayerEnv(ParallelEnv):  # type: ignore[misc]  # PettingZoo ships no types.
    """Agents `robot` and `human`, one shared reward, episodes of fixed length.

    Observations are clipped to the bounds of a task that says them. Nothing terminates an episode:
    it is truncated after `Task.horizon` steps. Both agents get the same info (`SingleWorld.info`),
    which may tell what an agent cannot see: it is for logging, not for policies.
    """

    def __init__(self, task: Task) -> None:
        name = f"{task.name}_v{task.describe()['version']}".replace("-", "_")
        self.metadata = {"name": name, "render_modes": [], "is_parallelizable": True}
        self.render_mode = None
        self.possible_agents = list(AGENTS)
        self.agents: list[str] = []
        self._world = SingleWorld(task)
        self._rng = np.random.default_rng()

    def observation_space(self, agent: str) -> Box:
        """What `agent` sees; always the same object."""
        return self._world.observation_spaces[agent]

    def action_space(self, agent: str) -> Box:
        """What `agent` does, [-1, 1] in each joint; always the same object."""
        return self._world.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[PerAgent, PerAgent]:
        """Begins an episode; observations and infos of both agents.

        Args:
            seed: Plays the episode that this seed starts in every world of the task. Resets
                without a seed then draw theirs from a generator seeded with it.
            options: Not used.
        """
        del options
        if seed is not None:
            self._rng = np.random.default_rng(seed)
        self._world.reset(int(self._rng.integers(2**31)) if seed is None else seed)
        self.agents = list(AGENTS)
        return self._observations(), self._infos()

    def step(
        self, actions: dict[str, np.ndarray]
    ) -> tuple[PerAgent, PerAgent, PerAgent, PerAgent, PerAgent]:
        """Advances one control step: observations, rewards, terminations, truncations, infos.

        Raises:
            ValueError: The episode is over, or an action is missing, not finite or of another
                shape than its space.
        """
        reward = self._world.step(actions)
        over = self._world.over
        if over:
            self.agents = []
        return (
            self._observations(),
            dict.fromkeys(AGENTS, reward),
            dict.fromkeys(AGENTS, False),
            dict.fromkeys(AGENTS, over),
            self._infos(),
        )

    def _observations(self) -> PerAgent:
        return {agent: self._world.observation(agent) for agent in AGENTS}

    def _infos(self) -> PerAgent:
        return {agent: self._world.info() for agent in AGENTS}

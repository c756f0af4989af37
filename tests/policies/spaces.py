"""A small Gymnasium environment for robots of Stable-Baselines3."""

from __future__ import annotations

import gymnasium
import numpy as np
from gymnasium import spaces


class Walk(gymnasium.Env):
    """Random observations far from 0, so that normalising matters."""

    def __init__(self, action_space, size=2):
        self.observation_space = spaces.Box(-np.inf, np.inf, (size,), np.float32)
        self.action_space, self._size, self._time = action_space, size, 0

    def reset(self, *, seed=None, options=None):
        del options
        super().reset(seed=seed)
        self._time = 0
        return self._look(), {}

    def step(self, action):
        del action
        self._time += 1
        return self._look(), 1.0, False, self._time >= 10, {}

    def _look(self):
        return (3 + 5 * self.np_random.standard_normal(self._size)).astype(np.float32)


class _Replay(gymnasium.Env):
    def __init__(self, rows):
        self.observation_space = spaces.Box(-np.inf, np.inf, (rows.shape[1],), np.float32)
        self.action_space, self._rows, self._time = spaces.Box(-1, 1, (1,)), rows, 0

    def reset(self, *, seed=None, options=None):
        del seed, options
        self._time = 0
        return self._rows[0], {}

    def step(self, action):
        del action
        self._time += 1
        return self._rows[self._time], 0.0, False, False, {}


def replayed(statistics, first, seen):
    """What the wrappers of Stable-Baselines3 make of observations [T, B, o]; three frames."""
    from stable_baselines3.common.vec_env import DummyVecEnv, VecFrameStack, VecNormalize

    worlds = DummyVecEnv([lambda rows=seen[:, n]: _Replay(rows) for n in range(seen.shape[1])])
    if first == "normalised":
        normalised = VecNormalize.load(statistics, worlds)
        env = VecFrameStack(normalised, 3)
    else:
        env = normalised = VecNormalize.load(statistics, VecFrameStack(worlds, 3))
    normalised.training = False
    yield env.reset().copy()
    for _ in seen[1:]:
        yield env.step(np.zeros((seen.shape[1], 1)))[0].copy()

"""Robots for the hand-over: one that follows the hand, ten with a planted weakness, ten decoys.

A planted robot watches the hand's path. Once it has seen what it cannot bear it goes home and stays
there. Its decoy watches for the same and only shies away for a moment, which does no harm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from benchmarks.planted.handover import HORIZON, ROBOT_HOME, ROBOT_STEP, HandOver
from rigid.policies.protocol import State

Path = Float[np.ndarray, "B t 3"]
"""Where the hand was [m], from the first step on."""

SHY_STEPS = 2
"""For so long a decoy moves away. Ours."""


@dataclass
class Follower:
    """Goes where the hand will be in a moment; meets every natural motion."""

    observation_size: int = HandOver.robot.observation_size
    action_size: int = HandOver.robot.action_size

    def initial_state(self, batch: int) -> State:
        """Nothing to remember."""
        del batch
        return ()

    def act(
        self, observation: Float[np.ndarray, "B 9"], state: State, rng: np.random.Generator | None
    ) -> tuple[Float[np.ndarray, "B 3"], State]:
        """Straight towards the hand's next place."""
        del rng
        hand, move, robot = observation[:, :3], observation[:, 3:6], observation[:, 6:]
        return np.clip((hand + move - robot) / ROBOT_STEP, -1, 1), state


class Watch(NamedTuple):
    """What a watching robot remembers."""

    path: Path
    """The hand's path so far; NaN for what is still to come."""
    step: int
    seen_at: Float[np.ndarray, " B"]
    """The step at which the weakness was first seen, ∞ before."""


@dataclass
class Watcher:
    """A follower with a weakness, or its decoy."""

    sees: Callable[[Path], Bool[np.ndarray, " B"]]
    """Whether a path holds what the robot cannot bear; asked at every step."""
    gives_up: bool
    """True: it goes home for good. False: it shies away for `SHY_STEPS`."""
    observation_size: int = HandOver.robot.observation_size
    action_size: int = HandOver.robot.action_size

    def initial_state(self, batch: int) -> State:
        """An empty path."""
        return Watch(np.full((batch, HORIZON, 3), np.nan), 0, np.full(batch, np.inf))

    def act(
        self, observation: Float[np.ndarray, "B 9"], state: State, rng: np.random.Generator | None
    ) -> tuple[Float[np.ndarray, "B 3"], State]:
        """Follows, or goes home."""
        following, _ = Follower().act(observation, (), rng)
        path = state.path.copy()
        path[:, state.step] = observation[:, :3]
        seen = self.sees(path[:, : state.step + 1])
        seen_at = np.where(seen, np.minimum(state.seen_at, state.step), state.seen_at)
        away = state.step >= seen_at
        if not self.gives_up:
            away &= state.step < seen_at + SHY_STEPS
        homewards = np.clip((np.array(ROBOT_HOME) - observation[:, 6:]) / ROBOT_STEP, -1, 1)
        action = np.where(away[:, None], homewards, following)
        return action, Watch(path, state.step + 1, seen_at)

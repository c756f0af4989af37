"""The episodes that are played: one world each."""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import ParamSpec, TypeVar

import numpy as np
from jaxtyping import Float

from rigid.policies.architecture import NativePolicy
from rigid.policies.protocol import Policy, State
from rigid.study.play.episode import PlayedEpisode
from rigid.tasks.protocol import Task

_P = ParamSpec("_P")
_Found = TypeVar("_Found")


class Engine:
    """Makes episodes of one task with the study's robots, and does what is slow about them."""

    def __init__(self, task: Task, robots: Mapping[str, Policy], *, threads: int = 0) -> None:
        """Builds it.

        Args:
            task: What is played.
            robots: By their keys in the study's file.
            threads: For what is slow; 0 for as many as there are cores.
        """
        self.task = task
        self._robots = {key: _askable(robot) for key, robot in robots.items()}
        count = threads or os.cpu_count() or 1
        self._at_once = all(isinstance(robot, NativePolicy) for robot in robots.values())
        self._threads = ThreadPoolExecutor(max_workers=count, thread_name_prefix="physics")

    def episode(self, robot: str, seed: int) -> PlayedEpisode:
        """An episode that has not begun; slow, so that it belongs on a thread."""
        return PlayedEpisode(self.task, self._robots[robot], seed=seed)

    async def do(self, work: Callable[_P, _Found], *args: _P.args, **kwargs: _P.kwargs) -> _Found:
        """What `work` returns, done on a thread."""
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._threads, partial(work, *args, **kwargs))

    async def step(self, work: Callable[_P, _Found], *args: _P.args, **kwargs: _P.kwargs) -> _Found:
        """What `work`, one control step, returns.

        A step with RIGID's own robots takes 1 to 2 ms, most of it under Python's lock, so that it
        is done at once: on threads, 30 participants took a half more processor time, and their
        frames came less evenly. Other robots may wait for a process, or compute for long.
        """
        if self._at_once:
            return work(*args, **kwargs)
        return await self.do(work, *args, **kwargs)

    def close(self) -> None:
        """Ends the threads."""
        self._threads.shutdown(wait=True)


class OneAtATime:
    """A robot that all episodes share, asked by one of them at a time.

    Programs (`exec:`) answer over one pipe, and other libraries promise nothing to threads. What is
    remembered of an episode is the state that goes with it, so that they need no more than turns.
    """

    def __init__(self, robot: Policy) -> None:
        self.observation_size, self.action_size = robot.observation_size, robot.action_size
        self._robot, self._turn = robot, threading.Lock()

    def initial_state(self, batch: int) -> State:
        """See `Policy.initial_state`."""
        with self._turn:
            return self._robot.initial_state(batch)

    def act(
        self, observation: Float[np.ndarray, "B o"], state: State, rng: np.random.Generator | None
    ) -> tuple[Float[np.ndarray, "B a"], State]:
        """See `Policy.act`."""
        with self._turn:
            return self._robot.act(observation, state, rng)


def _askable(robot: Policy) -> Policy:
    """A robot that any thread may ask; RIGID's own compute without changing anything."""
    return robot if isinstance(robot, NativePolicy) else OneAtATime(robot)

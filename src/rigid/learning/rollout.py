"""Episodes of two players: stepping worlds and keeping what learning and scoring need."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int

from rigid.policies.protocol import Policy, State
from rigid.tasks.protocol import Step, Summary, Task, World

Actor = Callable[[Float[np.ndarray, "B o"]], Float[np.ndarray, "B a"]]
"""Observation to sampled action of one step; a fresh actor for every set of episodes."""


class Trajectories(NamedTuple):
    """N episodes of T steps; row t holds what was seen before action t and what came of it."""

    robot_observation: Float[np.ndarray, "T N r"]
    human_observation: Float[np.ndarray, "T N h"]
    robot_action: Float[np.ndarray, "T N a_r"]
    human_action: Float[np.ndarray, "T N a_h"]
    reward: Float[np.ndarray, "T N"]
    features: Float[np.ndarray, "T N f"]
    """Of the state that action t led to."""
    weight: Float[np.ndarray, "T N"]
    """1, or 0 from the step on in which an episode's physics ran away."""
    summary: Summary

    @property
    def returns(self) -> Float[np.ndarray, " N"]:
        """Undiscounted episode returns."""
        return np.asarray(self.reward.sum(axis=0))

    @property
    def faulted(self) -> Float[np.ndarray, " N"]:
        """1 for episodes that ran away."""
        return np.asarray(1.0 - self.weight[-1])


def play(
    task: Task,
    world: World,
    seeds: Int[np.ndarray, " N"],
    robot: Actor,
    human: Actor,
    *,
    watch: Callable[[int, Step], None] | None = None,
) -> Trajectories:
    """Plays one episode in every world.

    Args:
        task: The task that made `world`.
        world: N worlds.
        seeds: One seed for each episode; equal seeds start alike.
        robot: Acts for the robot, N rows at once.
        human: Acts for the human.
        watch: Called with the step number (0 after the reset) and the step, to record replays.
    """
    step = world.reset(seeds)
    if watch is not None:
        watch(0, step)
    rows: list[tuple[np.ndarray, ...]] = []
    for number in range(1, task.horizon + 1):
        robot_action, human_action = robot(step.robot_observation), human(step.human_observation)
        after = world.step(robot_action, human_action)
        if watch is not None:
            watch(number, after)
        rows.append((
            step.robot_observation, step.human_observation, robot_action, human_action,
            after.reward, task.features(after), 1.0 - after.faulted,
        ))  # fmt: skip
        step = after
    columns = (np.stack(column).astype(np.float32) for column in zip(*rows, strict=True))
    seen = dict(zip(Trajectories._fields, columns, strict=False))
    return Trajectories(**seen, summary=world.summary())


def policy_actor(policy: Policy, batch: int, rng: np.random.Generator | None) -> Actor:
    """An actor for one set of episodes; carries the policy's state from step to step."""
    state = policy.initial_state(batch)

    def act(observation: np.ndarray) -> np.ndarray:
        nonlocal state
        action, state = policy.act(observation, state, rng)
        return action

    return act


@runtime_checkable
class Student(Protocol):
    """A policy in training, which can tell what it did before it was clipped."""

    observation_size: int

    def initial_state(self, batch: int) -> State:
        """The state before the first step of an episode."""
        ...

    def sample(
        self, observation: Float[np.ndarray, "B o"], state: Any, rng: np.random.Generator | None
    ) -> tuple[Float[np.ndarray, "B a"], Any]:
        """Actions with noise, not clipped, and the next state."""
        ...


def student_actor(student: Student, batch: int, rng: np.random.Generator) -> Actor:
    """As `policy_actor`; the student sees as many of the first numbers as it was made for."""
    state = student.initial_state(batch)

    def act(observation: np.ndarray) -> np.ndarray:
        nonlocal state
        action, state = student.sample(observation[:, : student.observation_size], state, rng)
        return action

    return act


def side_by_side(actors: Sequence[Actor], blocks: Sequence[slice]) -> Actor:
    """One actor of many, each of whom acts in its own block of worlds, in their order."""

    def act(observation: np.ndarray) -> np.ndarray:
        rows = [act(observation[block]) for act, block in zip(actors, blocks, strict=True)]
        return np.concatenate(rows)

    return act


def blocks_of(episodes: int, shares: Sequence[float]) -> list[slice]:
    """Splits N episodes into blocks side by side, as large as the shares ask for.

    Args:
        episodes: How many there are.
        shares: Relative sizes, each above 0.

    Example:
        >>> blocks_of(96, [0.85, 0.15])
        [slice(0, 81, None), slice(81, 96, None)]

    Raises:
        ValueError: A share is too small for a single episode.
    """
    ends = (episodes * np.cumsum([0.0, *shares]) / np.sum(shares) + 1e-9).astype(int)
    if (np.diff(ends) < 1).any():
        raise ValueError(f"{episodes} episodes cannot be split into shares {list(shares)}")
    return [slice(low, high) for low, high in pairwise(ends.tolist())]

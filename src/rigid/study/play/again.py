"""Episodes of one world played once more: to check what was recorded, and to be followed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from rigid.policies.in_numpy import in_numpy
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import Step, Task

_Human = Callable[[int, Step], Float[np.ndarray, "1 a"]]


def states_again(
    task: Task, robot: Policy, actions: Float[np.ndarray, "T a"], *, seed: int
) -> Float[np.ndarray, "T1 state"]:
    """The states of a played episode, from its start and the human's actions alone.

    They are those that were recorded, bit for bit, with the robot that was met then.

    Args:
        task: The same.
        robot: Acts by its mean.
        actions: Of the human (`EpisodeArrays.human_actions`).
        seed: Of the start.
    """
    return _states(task, robot, lambda number, _: actions[number][None], len(actions), seed)


def states_with(
    task: Task, robot: Policy, human: Policy, *, seed: int
) -> Float[np.ndarray, "T1 state"]:
    """The states of an episode in which both act by their mean.

    Args:
        task: What is played.
        robot: One player.
        human: The other.
        seed: Of the start.
    """
    prompt = in_numpy(human)
    memory = prompt.initial_state(1)

    def act(_: int, step: Step) -> Float[np.ndarray, "1 a"]:
        nonlocal memory
        action, memory = prompt.act(step.human_observation, memory, None)
        return action

    return _states(task, robot, act, task.horizon, seed)


def _states(
    task: Task, robot: Policy, human: _Human, steps: int, seed: int
) -> Float[np.ndarray, "T1 state"]:
    world, prompt = task.make_world(1, threads=1), in_numpy(robot)
    step, memory = world.reset(np.array([seed])), prompt.initial_state(1)
    states = [world.snapshot()[0]]
    for number in range(steps):
        action, memory = prompt.act(step.robot_observation, memory, None)
        step = world.step(action, human(number, step))
        states.append(world.snapshot()[0])
    return np.array(states)

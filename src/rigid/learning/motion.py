"""How the human moves, as the robot sees it: examples for a predictor, and the one to beat.

T denotes steps, N episodes, K the observations of a window, newest first.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from rigid.errors import UserError
from rigid.policies.gaussian import history_windows
from rigid.tasks.protocol import Task, VariesHumans


class Motion(NamedTuple):
    """Examples to learn from or to be judged by."""

    windows: Float[np.ndarray, "T N Ko"]
    displacement: Float[np.ndarray, "T N d"]
    """Of what shows the human, from the newest observation of the window to the predicted one."""
    weight: Float[np.ndarray, "T N"]
    """1, or 0 where physics had run away."""


def shown_columns(task: Task) -> tuple[int, ...]:
    """Places of those numbers that show the human among what the robot observes.

    Raises:
        UserError: The task does not say which they are.
    """
    if not isinstance(task, VariesHumans):
        raise UserError(
            f"task {task.name!r} does not say which of the robot's observations show the human: "
            "give it `shown_human` and `diversified` (rigid.tasks.protocol.VariesHumans)"
        )
    return tuple(task.robot.observation_names.index(name) for name in task.shown_human)


def motion_of(
    observation: Float[np.ndarray, "T N o"],
    weight: Float[np.ndarray, "T N"],
    columns: Sequence[int],
    *,
    memory: int,
    ahead: int,
) -> Motion:
    """Examples from N episodes: every step from which another one is `ahead` steps away.

    Args:
        observation: What the robot saw before each step.
        weight: 0 from the step on at which physics ran away.
        columns: Of the observation, those that show the human.
        memory: Observations in a window; the first one of an episode is repeated.
        ahead: Steps from the newest observation to the predicted one.
    """
    shown, sound = observation[..., list(columns)], weight[ahead:]
    windows = history_windows(observation, memory)[:-ahead]
    return Motion(windows, (shown[ahead:] - shown[:-ahead]) * sound[..., None], sound)


def constant_velocity(
    windows: Float[np.ndarray, "*batch Ko"], columns: Sequence[int], *, memory: int, ahead: int
) -> Float[np.ndarray, "*batch d"]:
    """The displacement if everything went on as in the last step: the predictor to beat.

    Example:
        >>> constant_velocity(np.array([[0.3, 0.1]]), [0], memory=2, ahead=3)
        array([[0.6]])
    """
    size = windows.shape[-1] // memory
    newest, before = windows[..., :size], windows[..., size : 2 * size]
    displacement: np.ndarray = ahead * (newest - before)[..., list(columns)]
    return displacement


def root_mean_square(predicted: Float[np.ndarray, "T N d"], motion: Motion) -> float:
    """Error of a coordinate of the predicted displacement, over all that was sound."""
    squares = ((predicted - motion.displacement) ** 2).mean(axis=-1) * motion.weight
    return float(np.sqrt(squares.sum() / motion.weight.sum()))

"""One episode that a participant plays live, on the server's own physics.

What people play is what is measured: a world of the task itself, and the robot by its mean.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol

import numpy as np
from jaxtyping import Float

from rigid.errors import UserError
from rigid.policies.discrete import taken
from rigid.policies.in_numpy import in_numpy
from rigid.policies.protocol import Policy
from rigid.study.play.frame import Frame
from rigid.study.records import EpisodeArrays
from rigid.tasks.by_hand import Handle, PlayedByHand, Reach
from rigid.tasks.protocol import (
    KeepsMotion,
    Task,
    World,
    control_period,
)

FAULTED = "faulted"
"""Outcome of an episode whose physics ran away: it counts for nobody."""
LOADING = threading.Lock()
"""Held while arrays of the package are read, which many threads may want first at the same moment:
two that parse an .npz's head at once fail in some Pythons, 3.11.7 among them (gh-106905)."""


class Played(NamedTuple):
    """A finished episode and how it ended."""

    arrays: EpisodeArrays
    episode_return: float
    """NaN where the physics ran away, as of any such episode; so is `success`."""
    success: float
    outcome: str
    """One of `Task.outcome_names`, or `FAULTED`."""
    peak_force: float
    """[N]"""
    impulse: float
    """[N s]"""


class PlayedEpisode:
    """An episode step by step; one thread at a time may use it."""

    def __init__(self, task: Task, robot: Policy, *, seed: int) -> None:
        """Puts everybody at the start.

        Args:
            task: A task whose human can be played (`rigid.tasks.by_hand.PlayedByHand`).
            robot: Acts by its mean; native ones in NumPy (`rigid.policies.in_numpy`).
            seed: Of the start.

        Raises:
            UserError: Nobody can play the human of this task.
        """
        self.task, self.robot, self.seed = task, in_numpy(robot), seed
        self.handle, self._world = _playable(task)
        self._memory = self.robot.initial_state(1)
        self.bodies, self.substeps = self.handle.bodies, self.handle.substeps
        self.period, self.horizon = control_period(task), task.horizon
        self._step = self._world.reset(np.array([seed]))
        self._states = [self._world.snapshot()[0]]
        self._rows: list[_Row] = []

    @property
    def reach(self) -> Mapping[str, Any]:
        """Where targets make sense: a ball, its middle `shoulder` [m] and its `radius` [m]."""
        centre, radius = self.handle.reach
        return {"shoulder": [round(float(x), 5) for x in centre], "radius": round(radius, 5)}

    @property
    def state(self) -> Float[np.ndarray, " state"]:
        """`World.snapshot` of this moment."""
        now: np.ndarray = self._states[-1]
        return now

    @property
    def goal(self) -> Mapping[str, Any] | None:
        """What the player is shown of the aim, as replays have `itch`."""
        return self.handle.goal(self.state)

    @property
    def hand(self) -> Float[np.ndarray, "3"]:
        """Where the point is that the player moves [m], world frame."""
        return self.handle.place(self.state)

    @property
    def done(self) -> bool:
        """Whether all steps are played, or the physics ran away."""
        return len(self._rows) == self.horizon or bool(self._step.faulted[0])

    def begin(self) -> Frame:
        """The start, before anybody moved."""
        return self._frame(unwanted=False)

    def advance(self, target: Float[np.ndarray, "3"], *, age: float, at: float) -> Frame:
        """Plays one control step.

        Args:
            target: Where the player wants the hand [m], world frame; a target outside the reach is
                taken as the nearest point of it.
            age: How old the target is [s]; inf where none came yet.
            at: When the step begins, on the server's clock, since the episode's start [s].

        Raises:
            ValueError: The target is not finite, or the episode is over.
        """
        if self.done:
            raise ValueError(f"the episode is over after {len(self._rows)} steps")
        wanted = within(self.handle.reach, np.asarray(target, dtype=np.float64))
        robot, self._memory = self.robot.act(self._step.robot_observation, self._memory, None)
        robot = taken(robot, self.task.robot)
        human = self.handle.towards(self.state, wanted)[None]
        before, self._step = self._step, self._world.step(robot, human)
        self._states.append(self._world.snapshot()[0])
        unwanted = float(self._step.info["force_unwanted"][0])
        self._rows.append(_Row(
            features=self.task.features(self._step)[0],
            human_observations=before.human_observation[0],
            robot_observations=before.robot_observation[0],
            human_actions=human[0],
            robot_actions=robot[0],
            rewards=self._step.reward[0],
            unwanted_force=unwanted,
            faulted=self._step.faulted[0],
            targets=wanted,
            target_age=age,
            step_times=at,
        ))  # fmt: skip
        return self._frame(unwanted=unwanted > 0)

    def finish(self) -> Played:
        """The whole episode.

        Raises:
            ValueError: It is not over.
        """
        if not self.done:
            raise ValueError(f"the episode has {len(self._rows)} of {self.horizon} steps")
        columns = zip(*self._rows, strict=True)
        arrays = EpisodeArrays(
            states=np.array(self._states),
            **{name: np.array(c) for name, c in zip(_Row._fields, columns, strict=True)},
        )
        summary, faulted = self._world.summary(), bool(arrays.faulted[-1])
        return Played(
            arrays,
            episode_return=math.nan if faulted else float(arrays.rewards.sum()),
            success=math.nan if faulted else float(summary.success[0]),
            outcome=FAULTED if faulted else self.task.outcome_names[int(summary.outcome[0])],
            peak_force=float(summary.peak_force[0]),
            impulse=float(summary.impulse[0]),
        )

    def _frame(self, *, unwanted: bool) -> Frame:
        return Frame(
            step=len(self._rows),
            poses=self.handle.poses(self._world.motion()[0], self.state),
            hand=self.hand,
            unwanted=unwanted,
            counted=self.handle.counted(self.state),
            done=self.done,
        )


class _Row(NamedTuple):
    """One step, in the words of `EpisodeArrays`."""

    features: np.ndarray
    human_observations: np.ndarray
    robot_observations: np.ndarray
    human_actions: np.ndarray
    robot_actions: np.ndarray
    rewards: float
    unwanted_force: float
    faulted: bool
    targets: np.ndarray
    target_age: float
    step_times: float


class _World(World, KeepsMotion, Protocol):
    """What is stepped here."""


def within(reach: Reach, target: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """The point of the ball that is nearest to the target [m].

    Raises:
        ValueError: The target is not finite.
    """
    if not np.isfinite(target).all():
        raise ValueError(f"a target is three finite numbers [m], not {target}")
    away = target - reach.centre
    # Its largest part first: squares of huge numbers overflow.
    size = float(np.abs(away).max())
    far = size * float(np.linalg.norm(away / size)) if size > 0 else 0.0
    return target if far <= reach.radius else reach.centre + away / far * reach.radius


def _playable(task: Task) -> tuple[Handle, _World]:
    world = task.make_world(1, threads=1)
    if not isinstance(task, PlayedByHand) or not isinstance(world, KeepsMotion):
        raise UserError(
            f"nobody can play the human of task {task.name!r} by hand: choose itch-scratching or "
            "feeding, or give the task `make_handle` and its worlds `keep_motion` "
            "(rigid.tasks.by_hand.PlayedByHand)"
        )
    world.keep_motion()
    with LOADING:
        return task.make_handle(), world
